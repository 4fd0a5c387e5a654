// Irradiance from a polygonal luminaire past occluders, with the luminaire's unoccluded irradiance,
// known by Lambert's formula, as the control.

#include "correlated/area_pairs.h"
#include "correlated/parameters.h"

namespace assay::plugins {

std::vector<Entry> correlated_area() {
  return correlated::entries(
      {.name = "correlated/area",
       .integral = "Irradiance from a polygonal luminaire",
       .description =
           "f is the irradiance that arrives from a point of the luminaire, g what would arrive if "
           "nothing stood in the way: g/p = A L cos+(receiver) cos+(light) / r^2 at points uniform "
           "on its area A, f = g [visible]; J is Lambert's formula for the polygon clipped at the "
           "receiver's horizon. One shadow ray a primary, none where a cosine is zero.",
       .parameters = luminaire::information("", "", "").parameters,
       .read = [](Parameters& given) -> correlated::SharedPairs {
         return correlated::read_area_pairs(given);
       }});
}

}  // namespace assay::plugins
