#include "harness/run/observation_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "estimators/core/flush_denormals.h"
#include "estimators/core/quoting.h"
#include "harness/draws/consistency_setup.h"
#include "harness/draws/sampler_setup.h"

namespace assay::harness {

bool same_number(double one, double other) {
  return one == other || (std::isnan(one) && std::isnan(other));
}
namespace {

/// The command that repeats one observation; "" of a claim in a test binary.
std::string replay_line(const TestOutcome& outcome, std::uint64_t observation) {
  if (outcome.question.test->where.file.empty()) return "";
  return fmt::format("; `assay replay {} {}` draws it again",
                     shell_quoted(outcome.question.test->id), observation);
}

std::string not_finite(const TestOutcome& outcome, const Subject& side, const Drawn& drawn,
                       std::size_t channel) {
  const ChannelSummary& summary = drawn.summary().channels[channel];
  const Pool& pool = drawn.pool();
  const auto at = side.image ? " at " + element_place(*side.setup->image(), channel) : "";
  const auto place = side.setup->place_of(
      {.index = summary.first_nonfinite, .key = pool.key(), .primaries = pool.primaries()});
  // Whoever wrote a file finds its line, not a number of an observation.
  const std::string number = fmt::format("observation {}", summary.first_nonfinite);
  const std::string first = place.empty()
                                ? number + replay_line(outcome, summary.first_nonfinite)
                                : (is_recorded(side) ? "" : number + ", ") + "`" + place + "`";
  const std::string text =
      fmt::format("{} of {} observations of `{}`{} {} not finite, the first is {}",
                  summary.nonfinite, drawn.summary().count, side.estimator->name, at,
                  summary.nonfinite == 1 ? "is" : "are", first);
  if (place.empty()) return text;
  if (!side.image) return text + "; mend it; leaving it out would bias a mean";
  std::set<std::size_t> pixels;
  for (const std::size_t element : side.channels.all()) {
    if (drawn.summary().channels[element].nonfinite > 0)
      pixels.insert(element / side.image->components.size());
  }
  return fmt::format("{}; {} of {} pixels {} not finite in some picture{}", text, pixels.size(),
                     side.image->pixels(), pixels.size() == 1 ? "is" : "are", leave_out_nonfinite);
}

/// The sampler of that name, or the only one.
std::shared_ptr<const Sampler> sampler_of(const Setup& setup, const std::string& name) {
  const std::vector<NamedSampler> all = setup.samplers();
  const auto named = std::ranges::find(all, name, &NamedSampler::name);
  if (named != all.end()) return named->sampler;
  return all.size() == 1 ? all[0].sampler : nullptr;
}

bool draws_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const auto& setup = dynamic_cast<const SamplerSetup&>(*subject.setup);
  const Sampler& mine = setup.sampler();
  const auto original = sampler_of(*subject.estimator->original, setup.name());
  if (original == nullptr) return true;
  const FlushDenormals flush;
  for (std::uint64_t i = 0; i < observations; ++i) {
    Stream one(pool.key(), i);
    Stream other(pool.key(), i);
    const SamplerDraw draw = mine.sample(one);
    if (draw != original->sample(other)) return true;
    if (!draw.valid) continue;
    const Point& point = draw.point;
    if (!same_number(mine.density(point), original->density(point)) ||
        !same_number(mine.evaluate(point), original->evaluate(point))) {
      return true;
    }
  }
  return false;
}

bool estimates_differ(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  const Setup& original = *subject.estimator->original;
  const std::size_t channels = original.channel_count();
  if (subject.setup->channel_count() != channels) return true;
  for (std::size_t i = 0; i < channels; ++i) {
    if (subject.setup->channel(i).mean != original.channel(i).mean) return true;
  }
  const FlushDenormals flush;
  const std::unique_ptr<Estimator> one = subject.setup->make();
  const std::unique_ptr<Estimator> other = original.make();
  const KeptObservations& kept = *pool.kept();
  std::vector<double> a(channels);
  std::vector<double> b(channels);
  for (std::uint64_t i = 0; i < observations; ++i) {
    if (i < kept.size()) {
      kept.whole(i, a);
    } else {
      pool.draw_again(*one, i, a);
    }
    pool.draw_again(*other, i, b);
    if (a != b) return true;
  }
  return false;
}

}  // namespace

std::string where_it_stopped(const TestWork& work) {
  const std::vector<Sample> samples = work.samples();
  for (std::size_t subject = 0; subject < samples.size(); ++subject) {
    if (const Fault* fault = std::get_if<Fault>(&samples[subject])) {
      return sentence_of(*fault, work.outcome.question.subjects[subject]);
    }
  }
  return "";
}

std::string unusable(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  for (std::size_t subject = 0; subject < test.samples.size(); ++subject) {
    const Subject& side = outcome.question.subjects[subject];
    const Summary& drawn = test.samples[subject].summary();
    if (drawn.elements) continue;  // all finite
    for (const std::size_t channel : side.channels.all()) {
      if (drawn.channels[channel].nonfinite == 0) continue;
      return not_finite(outcome, side, test.samples[subject], channel);
    }
    if (std::string fault = outside_of_range(side, drawn); !fault.empty()) return fault;
  }
  return "";
}

std::string first_contradiction(const DrawnTest& test) {
  const TestOutcome& outcome = test.outcome;
  if (outcome.verdict != reports::Verdict::fail) return "";
  std::optional<std::pair<std::uint64_t, std::string>> first;
  try {
    first = first_inconsistent(test.samples[0].pool(), outcome.secondaries());
  } catch (...) {
    // It is found by drawing again, which may fail: a program that ends meanwhile takes no verdict
    // with it.
  }
  if (!first) return "";
  return fmt::format("{}, first at observation {}{}", first->second, first->first,
                     replay_line(outcome, first->first));
}

bool was_activated(const Subject& subject, const Pool& pool, std::uint64_t observations) {
  if (!subject.estimator->original) return true;
  return subject.purpose.empty() ? estimates_differ(subject, pool, observations)
                                 : draws_differ(subject, pool, observations);
}

}  // namespace assay::harness
