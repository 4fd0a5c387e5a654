// Irradiance from a sky past occluders, with a uniform sky of the same mean, unoccluded, as the
// control.

#include "correlated/parameters.h"
#include "correlated/sky_pairs.h"

namespace assay::plugins {

std::vector<Entry> correlated_sky() {
  return correlated::entries(
      {.name = "correlated/sky",
       .integral = "Irradiance from a sky",
       .description =
           "f is the irradiance that arrives from a direction of the sky, L cos+ V, g what would "
           "arrive from a uniform sky of the same mean radiance M if nothing stood in the way, M "
           "cos+; J = pi M. Directions are drawn as `sampling` says; by the cosine g/p = J is "
           "constant and corrects nothing. One shadow ray a primary, none below the horizon.",
       .parameters = correlated::sky_pair_parameters(),
       .read = [](Parameters& given) -> correlated::SharedPairs {
         return correlated::read_sky_pairs(given);
       }});
}

}  // namespace assay::plugins
