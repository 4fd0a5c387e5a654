#include "estimators/foreign/library_sampler.h"

#include <cmath>
#include <string>
#include <utility>

#include "estimators/foreign/library_setup.h"

namespace assay::foreign {

namespace {

class LibrarySampler final : public Sampler {
 public:
  LibrarySampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler)
      : library_(std::move(library)), sampler_(sampler) {}

  Domain domain() const override {
    constexpr std::array<Domain, 5> domains{Domain::interval, Domain::square, Domain::triangle,
                                            Domain::hemisphere, Domain::sphere};
    return domains[sampler_.domain];
  }
  std::array<double, 2> bounds() const override {
    if (sampler_.domain != ASSAY_INTERVAL) return {0, 1};
    return {sampler_.low, sampler_.high};
  }
  SamplerDraw sample(Stream& random) const override {
    const std::uint64_t key = random();
    AssayStream theirs = assay_stream(key, random());
    AssayDraw draw{.size = sizeof draw};
    const int status = sampler_.sample(library_->state(), &theirs, &draw);
    if (status != 0) {
      throw LibraryError(std::string("sampler `") + sampler_.name + "`: status " +
                         std::to_string(status) + " of sample()");
    }
    return {.point = {draw.point[0], draw.point[1], draw.point[2]},
            .density = draw.density,
            .weight = draw.weight,
            .valid = draw.no_point == 0};
  }
  double density(const Point& point) const override {
    return sampler_.density(library_->state(), point.data());
  }
  double evaluate(const Point& point) const override {
    return sampler_.evaluate(library_->state(), point.data());
  }
  double rounding() const override {
    return sampler_.rounding > 0 ? sampler_.rounding : Sampler::rounding();
  }

 private:
  std::shared_ptr<const PreparedLibrary> library_;
  AssaySampler sampler_;
};

}  // namespace

void require_whole(const AssaySampler& sampler) {
  const std::string name = sampler.name != nullptr ? sampler.name : "";
  if (name.empty() || sampler.sample == nullptr || sampler.density == nullptr ||
      sampler.evaluate == nullptr) {
    throw LibraryError("the sampler `" + name +
                       "` lacks its name, sample(), density() or evaluate()");
  }
  if (sampler.domain > ASSAY_SPHERE) {
    throw LibraryError("the sampler `" + name + "` has the domain " +
                       std::to_string(sampler.domain) + ", which is none");
  }
  if (sampler.domain == ASSAY_INTERVAL && !(sampler.low < sampler.high)) {
    throw LibraryError("the sampler `" + name + "` has an empty interval: set `low` and `high`");
  }
}

std::shared_ptr<const Sampler> library_sampler(std::shared_ptr<const PreparedLibrary> library,
                                               const AssaySampler& sampler) {
  return std::make_shared<LibrarySampler>(std::move(library), sampler);
}

}  // namespace assay::foreign
