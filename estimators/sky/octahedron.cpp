#include "sky/octahedron.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace assay::sky {

Octahedron::Octahedron(std::size_t level)
    : vertices_{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}} {
  if (level > 9) throw std::invalid_argument("Octahedron: level must be at most 9");
  // By octants: bit 0 for x < 0, bit 1 for y < 0, bit 2 for z < 0; counter-clockwise from outside.
  std::vector<Triangle> roots;
  for (std::uint32_t octant = 0; octant < 8; ++octant) {
    const std::uint32_t x = octant & 1;
    const std::uint32_t y = 2 + (octant >> 1 & 1);
    const std::uint32_t z = 4 + (octant >> 2 & 1);
    const bool mirrored = (x + y + z) % 2 == 1;
    roots.push_back(mirrored ? Triangle{y, x, z} : Triangle{x, y, z});
  }
  levels_.push_back(std::move(roots));
  // The vertex in the middle of an edge, made once.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        made.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) vertices_.push_back(normalised(vertices_[a] + vertices_[b]));
    return found->second;
  };
  while (levels_.size() <= level) {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : levels_.back()) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    levels_.push_back(std::move(finer));
  }
}

std::size_t Octahedron::triangle(const Vector3& w) const {
  std::size_t index = (w.x < 0 ? 1u : 0u) + (w.y < 0 ? 2u : 0u) + (w.z < 0 ? 4u : 0u);
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    // The middle part's edges run ab-bc-ca; a corner's part lies beyond the edge opposite to it.
    const auto& [ab, bc, ca] = levels_[level][4 * index + 3];
    const std::size_t part = beyond(ca, ab, w)   ? 0
                             : beyond(ab, bc, w) ? 1
                             : beyond(bc, ca, w) ? 2
                                                 : 3;
    index = 4 * index + part;
  }
  return index;
}

}  // namespace assay::sky
