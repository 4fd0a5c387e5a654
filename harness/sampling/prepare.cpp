#include "harness/sampling/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ranges>
#include <set>
#include <tuple>

#include "estimators/catalogue.h"
#include "harness/base/record_file.h"
#include "harness/base/refuse.h"
#include "harness/suite/yaml.h"
#include "reports/report_formats.h"

namespace assay::harness {
namespace {

/// The parameters on which an estimator's streams depend.
std::vector<std::string> parameter_names(const Information& information) {
  return mapped(information.parameters | std::views::filter(&ParameterInformation::shapes_draws),
                &ParameterInformation::name);
}

/// The members of a mutant's parameters that its original knows.
Value only(const Value& given, const std::vector<std::string>& names) {
  std::vector<Value::Member> kept = given.members();
  std::erase_if(kept,
                [&](const auto& member) { return std::ranges::count(names, member.first) == 0; });
  return Value::map(std::move(kept), given.where());
}

// ---- Recorded runs

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
  const auto bits = read_as<std::uint64_t>(first.stream, 16);
  if (bits && first.plugin != "recorded") run->stream = StreamKey{*bits};
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

/// Reads `run` and `estimator`. A test is eligible if its claim is about moments of that estimator
/// alone. It takes the one with most channels, then one with moments of costs, then the largest.
/// Costs that were not kept are known if the total divides by the number of observations: each then
/// cost the same. InputError if the record is unreadable, lacks the estimator, or has no eligible
/// test.
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

std::shared_ptr<const Setup> set_up(const Entry& entry, Parameters& parameters) {
  const bool of_run = entry.information.name == "recorded" && parameters.given("run");
  std::shared_ptr<const Setup> setup =
      of_run ? std::shared_ptr<const Setup>(read_recorded_run(parameters))
             : entry.prepare(parameters);
  parameters.require_all_read();
  return setup;
}

}  // namespace

Nature PreparedEstimator::nature() const {
  return setup->nature().value_or(
      Nature{.averages = entry->information.averages, .bias = entry->information.bias});
}

PreparedEstimator prepare(const EstimatorEntry& entry, const std::string& folder) {
  const Entry& plugin = find_plugin(entry.plugin, entry.where);
  Parameters parameters(entry.plugin, plugin.information.parameters, entry.parameters, folder);
  PreparedEstimator prepared{
      .name = entry.name,
      .listed = entry.name,
      .entry = &plugin,
      .setup = set_up(plugin, parameters),
      .parameters = parameters.canonical(),
      .folder = std::filesystem::weakly_canonical(folder).string(),
      .key_plugin = entry.plugin,
      .key_parameters = parameters.canonical(parameter_names(plugin.information)),
      .primaries = entry.primaries,
      .original = nullptr,
      .where = entry.where,
      .given = entry.parameters};
  if (const RecordedRun* run = as_recorded_run(*prepared.setup)) {
    if (entry.primaries.value_or(run->primaries) != run->primaries) {
      refuse(entry.where, "the moments of `{}` are of {} primaries each: leave `primaries` out",
             entry.name, run->primaries);
    }
    prepared.primaries = run->primaries;
  } else if (prepared.setup->observations() && entry.primaries.value_or(1) != 1) {
    refuse(entry.where, "`{}` reads finished observations: leave `primaries` out", entry.plugin);
  }
  if (!plugin.information.original.empty()) {
    const Entry& original = find_plugin(plugin.information.original, entry.where);
    const std::vector<std::string> names = parameter_names(original.information);
    Parameters theirs(original.information.name, original.information.parameters,
                      only(entry.parameters, names), folder);
    prepared.original = set_up(original, theirs);
    prepared.key_plugin = original.information.name;
    prepared.key_parameters = theirs.canonical(names);
  }
  return prepared;
}

void share_random_numbers(const Suite& suite, std::map<std::string, PreparedEstimator>& prepared) {
  std::map<std::string, std::string> leader;
  const auto leader_of = [&](std::string name) {
    while (leader.contains(name)) name = leader[name];
    return name;
  };
  for (const TestEntry& test : suite.tests) {
    if (!test.paired) continue;
    const std::vector<Source> sides = sources_of(test.claim);
    const std::string first = leader_of(sides.front().estimator);
    const std::string second = leader_of(sides.back().estimator);
    if (first != second) leader[second] = first;
  }
  for (const auto& [name, unused] : leader) {
    const auto from = prepared.find(leader_of(name));
    const auto to = prepared.find(name);
    if (from == prepared.end() || to == prepared.end()) continue;  // one could not be prepared
    to->second.key_plugin = from->second.key_plugin;
    to->second.key_parameters = from->second.key_parameters;
  }
}

StreamKey key_of(const PreparedEstimator& estimator, std::uint64_t seed, std::uint32_t copy,
                 const std::string& purpose) {
  const std::string plugin =
      purpose.empty() ? estimator.key_plugin : estimator.key_plugin + "#" + purpose;
  return stream_key(seed, plugin, estimator.key_parameters, copy);
}

const RecordedRun* as_recorded_run(const Setup& setup) {
  return dynamic_cast<const RecordedRun*>(&setup);
}

}  // namespace assay::harness
