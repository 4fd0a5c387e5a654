#include "estimators/foreign/library_sampler.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "estimators/foreign/library_setup.h"
#include "estimators/foreign/words.h"

namespace assay::foreign {

namespace {

bool is_whole(const SamplerDraw& draw) {
  return !std::isnan(draw.density) && !std::isnan(draw.weight) &&
         std::ranges::none_of(draw.point, [](double x) { return std::isnan(x); });
}

std::vector<double> numbers_of(const SamplerDraw& draw) {
  const auto& [x, y, z] = draw.point;
  return {x, y, z, draw.density, draw.weight, draw.valid ? 1.0 : 0.0};
}

}  // namespace

LibrarySampler::LibrarySampler(std::shared_ptr<const PreparedLibrary> library,
                               const AssaySampler& sampler)
    : library_(std::move(library)), sampler_(sampler), note_(note_of(sampler)) {}

SamplerDraw LibrarySampler::sample(Stream& random) const {
  const std::uint64_t key = random();
  return draw(key, random());
}

SamplerDraw LibrarySampler::draw(std::uint64_t key, std::uint64_t observation) const {
  AssayStream theirs = assay_stream(key, observation);
  AssayDraw drawn{.size = sizeof drawn};
  const int status = sampler_.sample(library_->state(), &theirs, &drawn);
  if (status != 0) {
    throw LibraryError("sampler `" + note_.name + "`: status " + std::to_string(status) +
                       " of sample()");
  }
  const SamplerDraw draw{.point = {drawn.point[0], drawn.point[1], drawn.point[2]},
                         .density = drawn.density,
                         .weight = drawn.weight,
                         .valid = drawn.no_point == 0};
  if (!draw.valid || is_whole(draw)) return draw;
  throw LibraryError("sampler `" + note_.name + "`: sample() gave the point " +
                     text_of(draw.point, note_.domain) + ", density " + text_of(draw.density) +
                     " and weight " + text_of(draw.weight));
}

double LibrarySampler::number(double value, const char* function, const Point& point) const {
  if (!std::isnan(value)) return value;
  throw LibraryError("sampler `" + note_.name + "`: " + function + " is " + text_of(value) +
                     " at " + text_of(point, note_.domain));
}

double LibrarySampler::density(const Point& point) const {
  return number(sampler_.density(library_->state(), point.data()), "density()", point);
}

double LibrarySampler::evaluate(const Point& point) const {
  return number(sampler_.evaluate(library_->state(), point.data()), "evaluate()", point);
}

double LibrarySampler::rounding() const {
  return note_.rounding > 0 ? note_.rounding : Sampler::rounding();
}

InProcessSampler::InProcessSampler(std::shared_ptr<const PreparedLibrary> library,
                                   const AssaySampler& sampler)
    : LibrarySampler(library, sampler), name_(sampler.name), file_(library->file()) {}

template <class Ask>
void InProcessSampler::look_at_first(Asked what, const Ask& ask) const {
  first_looks_[static_cast<std::size_t>(what)].at([&] {
    const std::vector<double> numbers = ask();
    const Question question{.first = static_cast<std::uint64_t>(what), .primaries = 0};
    return same_bits(ask(), numbers) ? ""
                                     : "sampler `" + name_ + "`: " + other_numbers(file_, question);
  });
}

SamplerDraw InProcessSampler::sample(Stream& random) const {
  const std::uint64_t key = random();
  const std::uint64_t observation = random();
  look_at_first(Asked::draws, [&] { return numbers_of(draw(key, observation)); });
  return draw(key, observation);
}

double InProcessSampler::density(const Point& point) const {
  look_at_first(Asked::densities, [&] { return std::vector{LibrarySampler::density(point)}; });
  return LibrarySampler::density(point);
}

double InProcessSampler::evaluate(const Point& point) const {
  look_at_first(Asked::evaluations, [&] { return std::vector{LibrarySampler::evaluate(point)}; });
  return LibrarySampler::evaluate(point);
}

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

SamplerNote note_of(const AssaySampler& sampler) {
  constexpr std::array<Domain, 5> domains{Domain::interval, Domain::square, Domain::triangle,
                                          Domain::hemisphere, Domain::sphere};
  SamplerNote note{.name = sampler.name, .domain = domains[sampler.domain]};
  if (note.domain == Domain::interval) note.bounds = {sampler.low, sampler.high};
  if (sampler.rounding > 0) note.rounding = sampler.rounding;
  return note;
}

}  // namespace assay::foreign
