// The sub-sampler of steerable sampling by itself: points of a triangle with linear density. Their
// mean barycentric coordinates are (W + w_i) / (4 W) with W = w_a + w_b + w_c.

#include "steerable/triangle.h"

#include "estimators/estimator.h"

namespace assay::plugins {

std::vector<Entry> steerable_triangle() {
  return {{{.name = "steerable/triangle",
            .summary = "Points of a triangle with a density linear between given vertex weights.",
            .description =
                "Channels a, b and c: the barycentric coordinates of a point of density "
                "proportional to the interpolated weights. Means (W + w_i) / (4 W), W the sum of "
                "the weights; second moments (W + 2 w_i) / (10 W). Samplers: `point` (u, v the "
                "coordinates of b and c), and `square`, the pair of numbers behind a point, of "
                "constant density.",
            .parameters = steerable::triangle_parameters()},
           [](Parameters& given) {
             return steerable::triangle_setup<steerable::LinearTriangle>(
                 steerable::read_weights(given), true);
           }}};
}

}  // namespace assay::plugins
