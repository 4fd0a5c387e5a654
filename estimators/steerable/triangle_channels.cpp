#include "steerable/triangle.h"

namespace assay::steerable {

std::vector<ParameterInformation> triangle_parameters() {
  return {{.name = "weights",
           .type = ParameterType::structure,
           .summary = "at the vertices a, b and c: none negative, not all zero",
           .fallback = "[1, 2, 5]"}};
}

VertexWeights read_weights(Parameters& given) {
  const Value& list = given.structure("weights");
  if (list.kind() != Value::Kind::list || list.items().size() != 3) {
    given.refuse("weights", "must be a list of three numbers");
  }
  std::array<double, 3> w{};
  for (std::size_t i = 0; i < w.size(); ++i) {
    w[i] = list.items()[i].number("a weight");
    if (!std::isfinite(w[i])) given.refuse("weights", "must be finite");
    if (w[i] < 0) given.refuse("weights", "must not be negative: a density cannot be");
  }
  if (w[0] + w[1] + w[2] == 0) given.refuse("weights", "must not all be zero");
  return {w[0], w[1], w[2]};
}

// Integrals over the triangle of products of its coordinates (Dirichlet). The density is 6 sum w_j
// l_j / W. E[l_i] = (W + w_i) / (4 W), and E[l_i^2] = (W + 2 w_i) / (10 W).
std::vector<Channel> triangle_channels(const VertexWeights& weights, bool with_variance) {
  const std::array<double, 3> w = {weights.a, weights.b, weights.c};
  const std::array<const char*, 3> names = {"a", "b", "c"};
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const double mean = (weights.sum() + w[i]) / (4 * weights.sum());
    const double square = (weights.sum() + 2 * w[i]) / (10 * weights.sum());
    Channel channel{.name = names[i], .mean = mean};
    if (with_variance) channel.variance = square - mean * mean;
    channels.push_back(channel);
  }
  return channels;
}

}  // namespace assay::steerable
