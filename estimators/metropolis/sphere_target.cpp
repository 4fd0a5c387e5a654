#include "metropolis/sphere_target.h"

#include <algorithm>
#include <utility>

#include "paths/walk.h"

namespace assay::metropolis {

namespace {

// The camera is of no account: paths start at the wall.
constexpr paths::Camera from_the_centre = {{0, 0, 0}, {0, 0, 1}};

}  // namespace

SphereTarget::SphereTarget(Form form)
    : form_(std::move(form)),
      world_(std::make_shared<const paths::SphereWorld>(form_.scene, from_the_centre)) {}

ImageShape SphereTarget::shape() const {
  ImageShape shape{.width = form_.width, .height = 1};
  if (!form_.grey) shape.components = {"red", "green", "blue"};
  return shape;
}

Contribution SphereTarget::at(Coordinates& point, Cost& cost) const {
  const double u = point.uniform();
  const render::Vector3 position = render::direction_at(2 * u - 1, point.uniform());
  paths::Tally tally;
  paths::walk(*world_, world_->zones().vertex(position), form_.survival, point, tally, cost);
  return {static_cast<std::size_t>(u * static_cast<double>(form_.width)), tally.value,
          form_.grey ? tally.value.red : paths::luminance(tally.value)};
}

std::vector<double> SphereTarget::means() const {
  const paths::ZonedScene& law = world_->zones().law();
  std::vector<double> all;
  for (std::size_t p = 0; p < form_.width; ++p) {
    const auto width = static_cast<double>(form_.width);
    const double low = 2 * static_cast<double>(p) / width - 1;
    const double high = 2 * static_cast<double>(p + 1) / width - 1;
    Spectrum sum;
    double below = -1;
    for (std::size_t z = 0; z < law.zones.size(); ++z) {
      const double top = form_.scene.zones[z].top;
      const double common = std::max(0.0, std::min(high, top) - std::max(low, below));
      const paths::Surface& surface = law.zones[z].surface;
      sum += common / (high - low) * (surface.emission + surface.diffuse * law.mean_radiance());
      below = top;
    }
    for (std::size_t c = 0; c < (form_.grey ? 1 : 3); ++c) all.push_back(component(sum, c));
  }
  return all;
}

}  // namespace assay::metropolis
