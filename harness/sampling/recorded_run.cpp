#include "harness/sampling/recorded_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <tuple>

#include "estimators/catalogue.h"
#include "harness/base/record_file.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"
#include "reports/report_formats.h"

namespace assay::harness {
namespace {

/// The samples of a test that are kept, each of another channel.
using Kept = std::vector<const reports::Sample*>;

auto worth(const Kept& kept) {
  return std::tuple(kept.size(), !kept[0]->with_cost.empty(), kept[0]->secondaries);
}

/// The samples of the estimator in a test. None for a test of something else, and if two sources
/// share a name and cannot be told apart.
Kept kept_in(const reports::Test& test, const std::string& estimator) {
  if (!test.over.empty() || test.image) return {};
  const Claim claim = parse_claim(test.claim, {.file = test.file});
  if (!claim.left.row->told_by_moments || claim.left.slope) return {};
  if (std::ranges::count(sources_of(claim), estimator, &Source::estimator) != 1) return {};
  Kept kept;
  std::set<std::string> channels;
  for (const reports::Sample& sample : test.samples) {
    if (sample.estimator != estimator) continue;
    if (sample.nonfinite > 0 || !sample.mean || !sample.variance) return {};
    if (channels.insert(sample.channel).second) kept.push_back(&sample);
  }
  return kept;
}

stats::Moments moments_of(const reports::Sample& sample) {
  const double n = static_cast<double>(sample.secondaries);
  stats::Moments moments{.count = sample.secondaries,
                         .mean = *sample.mean,
                         .m2 = *sample.variance * (n - 1),
                         .minimum = sample.min.value_or(*sample.mean),
                         .maximum = sample.max.value_or(*sample.mean),
                         .nonzero = sample.nonzero};
  const double spread = moments.m2 / n;
  moments.m3 = sample.skewness.value_or(0) * n * std::pow(spread, 1.5);
  moments.m4 = sample.kurtosis.value_or(0) * n * spread * spread;
  return moments;
}

Cost cost_of(const reports::Cost& recorded) {
  return {.camera_rays = recorded.camera_rays,
          .closest_hit_rays = recorded.closest_hit_rays,
          .shadow_rays = recorded.shadow_rays,
          .samples = recorded.samples};
}

/// Joint moments of values and one kind of cost; nullopt if unknown.
std::optional<stats::JointMoments> joint_of(const reports::Sample& sample, CountedCost kind) {
  for (const reports::CostMoments& kept : sample.with_cost) {
    if (kept.kind != cost_words[kind]) continue;
    stats::JointMoments joint = stats::joint_of_four(moments_of(sample), kept.mean);
    joint.sums[stats::JointMoments::place(0, 2)] = kept.m2;
    joint.sums[stats::JointMoments::place(1, 1)] = kept.m11;
    joint.sums[stats::JointMoments::place(2, 1)] = kept.m21;
    return joint;
  }
  const Cost cost = cost_of(sample.cost);
  const std::uint64_t total = kind == rays_cost ? cost.rays() : cost.samples;
  if (total % sample.secondaries != 0) return std::nullopt;
  return stats::joint_of_four(moments_of(sample), static_cast<double>(total / sample.secondaries));
}

std::shared_ptr<RecordedRun> run_of(const Kept& kept, const reports::Suite& suite) {
  const reports::Sample& first = *kept[0];
  auto run = std::make_shared<RecordedRun>();
  run->primaries = first.primaries;
  run->known_costs.fill(true);
  run->summary.count = first.secondaries;
  run->summary.cost = cost_of(first.cost);
  run->summary.seconds = first.cost.seconds;
  for (const reports::Sample* sample : kept) {
    run->names.push_back(sample->channel);
    const stats::Moments moments = moments_of(*sample);
    ChannelDetails& details = run->summary.detailed[run->summary.channels.size()];
    run->summary.channels.push_back({.moments = moments});
    for (const CountedCost kind : {rays_cost, samples_cost}) {
      const auto joint = joint_of(*sample, kind);
      run->known_costs[kind] = run->known_costs[kind] && joint;
      details.joint.emplace_back(joint.value_or(stats::joint_of_four(moments)));
    }
  }
  for (const reports::EstimatorSummary& row : suite.estimators) {
    if (row.name == first.estimator) run->averages = row.variance_of == "primary";
  }
  if (first.plugin != "recorded") run->stream = read_stream(first.stream);
  return run;
}

std::string wanted_estimator(Parameters& parameters, const reports::Record& record) {
  std::set<std::string> all;
  for (const reports::Test* test : reports::tests_of(record)) {
    for (const reports::Sample& sample : test->samples) all.insert(sample.estimator);
  }
  const std::vector<std::string> names(all.begin(), all.end());
  const std::string name = parameters.string("estimator");
  if (names.empty()) parameters.refuse("run", "is a record without observations");
  if (!parameters.given("estimator")) {
    if (names.size() == 1) return names[0];
    parameters.refuse("run", "has several estimators; choose one by `estimator`: " + quoted(names));
  }
  if (std::ranges::find(names, name) != names.end()) return name;
  parameters.refuse("estimator", "`" + name + "` is none of the run's" +
                                     did_you_mean(name, names, "there is: " + quoted(names)));
}

reports::Record read(Parameters& parameters) {
  const std::string file = parameters.file("run");
  try {
    return read_record(file);
  } catch (const reports::ReadError& error) {
    parameters.refuse("run", fmt::format("is no record of a run: {}", error.what()));
  } catch (const InputError& error) {
    parameters.refuse("run", fmt::format("is `{}`: {}", file, error.message()));
  }
}

}  // namespace

std::unique_ptr<Estimator> RecordedRun::make() const {
  throw std::logic_error("a recorded run has moments, not observations");
}

bool RecordedRun::knows_cost(CostKind kind) const {
  if (kind == CostKind::seconds) return false;
  return known_costs[kind == CostKind::rays ? rays_cost : samples_cost];
}

const RecordedRun* as_recorded_run(const Setup& setup) {
  return dynamic_cast<const RecordedRun*>(&setup);
}

std::shared_ptr<const RecordedRun> read_recorded_run(Parameters& parameters) {
  const Entry& recorded = find_plugin("recorded", {});
  for (const ParameterInformation& declared : recorded.information.parameters) {
    const std::string& other = declared.name;
    if (other == "run" || other == "estimator") continue;
    parameters.string(other);
    parameters.require(!parameters.given(other), other,
                       "is for rows of a file: give it or `run`, not both");
  }
  const reports::Record record = read(parameters);
  const std::string name = wanted_estimator(parameters, record);
  Kept best;
  const reports::Suite* of = nullptr;
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Test& test : suite.tests) {
      Kept kept = kept_in(test, name);
      if (kept.empty()) continue;
      if (of != nullptr && of != &suite) {
        parameters.refuse(
            "estimator",
            fmt::format("`{}` is in two suites of the run, `{}` and `{}`; record them separately",
                        name, of->name, suite.name));
      }
      of = &suite;
      if (best.empty() || worth(best) < worth(kept)) best = std::move(kept);
    }
  }
  if (best.empty()) {
    parameters.refuse(
        "estimator",
        fmt::format("`{}` has no moments in the run: only a claim on its mean, variance, cost or "
                    "efficiency keeps them, not of an image and not if some value was not finite",
                    name));
  }
  const std::shared_ptr<RecordedRun> run = run_of(best, *of);
  run->file = parameters.file("run");
  return run;
}

}  // namespace assay::harness
