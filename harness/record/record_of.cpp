#include "harness/record/record_of.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>

#include "estimators/instruction_set.h"
#include "estimators/ready_made.h"
#include "estimators/rendered.h"
#include "harness/base/numbers.h"
#include "harness/base/version.h"
#include "harness/plan/plan.h"
#include "harness/sampling/summary.h"
#include "harness/theta/ask.h"
#include "harness/theta/decision.h"
#include "harness/theta/methods.h"
#include "stats/gates/dependence.h"
#include "stats/means/student_t.h"
#include "stats/planning/holm.h"
#include "stats/tails/tails.h"
#include "stats/tails/test_result.h"
#include "stats/variances/influence.h"

namespace assay::harness {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// At most 99 points of a normal quantile plot of the values, at the probabilities (i - 1/2) / k.
std::vector<reports::QuantilePoint> quantile_points(std::span<const double> values) {
  std::vector<double> sorted;
  std::ranges::copy_if(values, std::back_inserter(sorted),
                       [](double value) { return std::isfinite(value); });
  std::ranges::sort(sorted);
  constexpr std::size_t most_points = 99;
  const std::size_t points = std::min(sorted.size(), most_points);
  return mapped_indices(points, [&](std::size_t i) {
    const double probability = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
    const auto rank = static_cast<std::size_t>(probability * static_cast<double>(sorted.size()));
    return reports::QuantilePoint{
        .normal = stats::normal_quantile({stats::Tail::lower, std::log(probability)}),
        .observed = sorted[rank]};
  });
}

reports::Cost cost_of(const Summary& summary) {
  return {.camera_rays = summary.cost.camera_rays,
          .closest_hit_rays = summary.cost.closest_hit_rays,
          .shadow_rays = summary.cost.shadow_rays,
          .samples = summary.cost.samples,
          .seconds = summary.seconds};
}

reports::Sample sample_of(const TestOutcome& outcome, std::size_t subject, const Drawn& drawn,
                          const std::string& channel) {
  const PreparedEstimator& estimator = *outcome.question.subjects[subject].estimator;
  return {.estimator = estimator.listed,
          .plugin = estimator.entry->information.name,
          .parameters = estimator.parameters,
          .channel = channel,
          .stream = fmt::format("{:016x}", drawn.pool().key().bits),
          .primaries = outcome.plan.primaries[subject],
          .secondaries = drawn.summary().count,
          .cost = cost_of(drawn.summary())};
}

reports::Sample sample_of(const TestOutcome& outcome, std::size_t subject, const Drawn& drawn,
                          std::size_t channel) {
  const Subject& side = outcome.question.subjects[subject];
  const std::size_t index = side.channels[channel];
  const ChannelSummary& kept = drawn.summary().channels[index];
  const stats::Moments& moments = kept.moments;
  const ChannelDetails& details = drawn.summary().details(index);
  const bool spread = moments.count > 1 && moments.m2 > 0;
  reports::Sample sample = sample_of(outcome, subject, drawn, side.declared(channel).name);
  sample.nonzero = moments.nonzero;
  sample.nonfinite = kept.nonfinite;
  // A record must not show what another test on the same observations kept.
  const bool costs = outcome.plan.method.keeps == Keeps::costs;
  for (std::size_t i = 0; costs && i < details.joint.size(); ++i) {
    const stats::JointMoments joint = details.joint[i].moments();
    sample.with_cost.push_back({.kind = cost_words[i],
                                .mean = joint.of_cost.mean,
                                .m2 = joint.sum(0, 2),
                                .m11 = joint.sum(1, 1),
                                .m21 = joint.sum(2, 1)});
  }
  // A cell's number is a name, without a mean.
  if (outcome.plan.method.keeps == Keeps::cells) return sample;
  if (moments.count > 0) {
    sample.mean = number(moments.mean);
    sample.min = number(moments.minimum);
    sample.max = number(moments.maximum);
  }
  if (moments.count > 1) sample.variance = number(moments.variance());
  if (spread) {
    sample.skewness = number(moments.skewness());
    sample.kurtosis = number(moments.kurtosis());
  }
  sample.histogram = details.histogram;
  if (spread && !drawn.pool().is_ready_made()) {
    const std::span<const double> values = drawn.values(index);
    sample.quantiles =
        quantile_points(values.first(std::min<std::size_t>(values.size(), plotted_values)));
  }
  return sample;
}

/// The samples of subjects without a fault.
std::vector<reports::Sample> samples_of(const TestWork& work) {
  std::vector<reports::Sample> samples;
  const TestOutcome& outcome = work.outcome;
  const std::vector<Subject>& subjects = outcome.question.subjects;
  // All channels, even if they make one number. An image is one row.
  const std::size_t rows = has_image(outcome.question) ? 1 : subjects[0].channels.size();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t subject = 0; subject < subjects.size(); ++subject) {
      const Sample sample = work.sample(subject);
      const Drawn* const drawn = std::get_if<Drawn>(&sample);
      const Subject& side = subjects[subject];
      if (drawn == nullptr || row >= side.channels.size()) continue;
      if (side.image) {
        samples.push_back(sample_of(outcome, subject, *drawn, image_name(*side.image)));
        add_elements(side, drawn->summary(), samples.back());
      } else {
        samples.push_back(sample_of(outcome, subject, *drawn, row));
      }
    }
  }
  return samples;
}

reports::Channel channel_of(const ChannelOutcome& outcome, const Regions& regions, bool has_p) {
  reports::Channel channel{.name = outcome.name,
                           .statistic = number(outcome.at_null.statistic),
                           .distribution = {.family = outcome.at_null.distribution.family,
                                            .parameters = outcome.at_null.distribution.parameters}};
  if (has_p) {
    channel.p_value = probability(outcome.decision.log_p_claimed);
    channel.log10_p = log10_of(outcome.decision.log_p_claimed);
  }
  if (has_p && regions.has_forbidden()) {
    channel.p_pass = probability(outcome.decision.log_p_forbidden);
    channel.log10_p_pass = log10_of(outcome.decision.log_p_forbidden);
  }
  channel.effect = outcome.effect;
  if (outcome.reference) channel.reference = number(*outcome.reference);
  return channel;
}

/// The p-values of each look, as of a single look. They belong to the channel that speaks most
/// against the claim, and to the one least excluded from the forbidden region.
std::vector<reports::Look> looks_of(const TestOutcome& outcome, const Regions& regions) {
  const std::size_t taken = outcome.history.empty() ? 0 : outcome.history[0].log_p_claimed.size();
  return mapped_indices(taken, [&](std::size_t k) {
    double claimed = 0;
    double forbidden = -std::numeric_limits<double>::infinity();
    for (const ChannelHistory& history : outcome.history) {
      claimed = std::min(claimed, history.log_p_claimed[k]);
      forbidden = std::max(forbidden, history.log_p_forbidden[k]);
    }
    reports::Look look{.secondaries = outcome.plan.looks.sizes[k],
                       .alpha = outcome.plan.looks.alpha[k],
                       .beta = outcome.plan.looks.beta[k],
                       .log10_p = log10_of(claimed)};
    if (regions.has_forbidden()) {
      look.p_pass = probability(forbidden);
      look.log10_p_pass = log10_of(forbidden);
    }
    if (!outcome.channels.empty()) {
      const ChannelOutcome& worst = outcome.channels[0];
      look.effect = outcome.history[worst.index].effect[k];
      if (look.effect) look.effect->quantity = worst.effect.quantity;
      // Earlier looks have no interval: its confidence depends on the verdict.
      if (look.effect && k + 1 == taken) look.effect = worst.effect;
    }
    return look;
  });
}

std::vector<reports::Statement> statements_of(const Suite& suite,
                                              const std::vector<reports::Test>& ran) {
  const auto has_run = [&](const std::string& name) {
    return std::ranges::any_of(ran, [&](const reports::Test& test) { return test.name == name; });
  };
  std::vector<reports::Statement> statements = suite.statements;
  std::erase_if(statements, [&](const reports::Statement& each) {
    return std::ranges::none_of(each.holds, has_run) && std::ranges::none_of(each.fails, has_run);
  });
  return statements;
}

reports::Test head_of(const TestEntry& entry, const std::string& file) {
  reports::Test test{.name = entry.name,
                     .id = entry.id,
                     .claim = entry.claim.text,
                     .file = file,
                     .line = entry.where.line,
                     .tags = entry.tags,
                     .paired = entry.paired,
                     .expected = entry.expect};
  if (const auto& over = entry.over) {
    const std::string values = listed(mapped(over->values, &Value::text));
    test.over = fmt::format("{{{}: [{}]}}", over->parameter, values);
  }
  if (entry.reference_number) test.reference = to_string(*entry.reference_number);
  if (entry.reference) test.reference = to_string(*entry.reference);
  if (entry.claim.left.row->counts_cost)
    test.cost = cost_words[static_cast<std::size_t>(entry.cost)];
  return test;
}

// ---- The estimators of the selected tests

/// True if moments suffice for intervals of mean and variance.
bool has_spread(const stats::Moments& moments) {
  return moments.count > 3 && moments.m2 > 0 && beyond_doubles(moments, "").empty();
}

using reports::Estimate;

const char* bias_name(std::optional<BiasClass> bias) {
  constexpr const char* names[] = {"unbiased", "O(1/M)", "O(1/bootstrap)", "start-up",
                                   "reconstruction"};
  return bias ? names[static_cast<int>(*bias)] : "unknown";
}

Estimate mean_of(const stats::Moments& moments, double confidence) {
  if (moments.count == 0) return {};
  if (moments.m2 == 0) return {number(moments.mean), number(moments.mean), number(moments.mean)};
  if (!has_spread(moments)) return {number(moments.mean), {}, {}};  // too few for an interval
  const stats::Interval interval = stats::student_t_interval(moments, {.value = 0}, confidence);
  return {number(moments.mean), number(interval.low), number(interval.high)};
}

Estimate variance_of(const stats::Moments& moments, double primaries, double confidence) {
  if (moments.count < 2) return {};
  if (moments.m2 == 0) return {0.0, 0.0, 0.0};
  const Estimate alone{number(primaries * moments.variance()), {}, {}};
  if (!has_spread(moments)) return alone;
  const stats::Influence influence = stats::influence_of_variance(stats::joint_of_four(moments));
  // Few observations make up most of what the variance's own spread is known from.
  const stats::Gate gate = stats::effective_observations_gate({&influence.relative, 1});
  if (gate.state == stats::GateState::red) return alone;
  const stats::Interval log = stats::interval_by_inversion(
      [&](double theta) { return stats::influence_t(influence, theta); },
      {.estimate = influence.log_value, .step = influence.relative.standard_error()}, confidence);
  return {number(primaries * moments.variance()), number(primaries * std::exp(log.low)),
          number(primaries * std::exp(log.high))};
}

/// Moments, which for dependent rows count only as many as independent ones would be worth.
stats::Moments moments_of(const PreparedEstimator& estimator, const SuiteRun& run,
                          const Drawn& drawn, std::size_t channel) {
  const stats::Moments& moments = drawn.summary().channels[channel].moments;
  const Pilot* const pilot = run.pilots.find(estimator.name);
  if (!estimator.setup->observations() || pilot == nullptr || !has_spread(moments)) return moments;
  const std::uint64_t count = drawn.summary().count;
  const std::span<const double> rows = pilot->values(channel);
  const bool all = moments.count == count && count <= rows.size();  // finite, and kept
  if (!all || count < fewest_in_order) return moments;
  const double factor = stats::allowance_for_dependence(rows.first(count));
  return factor > 1 ? stats::moments_of_fewer(moments, factor) : moments;
}

/// An estimator's mean and variance with intervals, by the test that drew most. Dependent rows
/// count as fewer (stats::allowance_for_dependence). Descriptive: outside the family.
reports::EstimatorSummary summarise(const PreparedEstimator& estimator, const SuiteRun& run) {
  const double confidence = 1 - run.suite.alpha;
  const Information& information = estimator.entry->information;
  const Nature nature = estimator.nature();
  reports::EstimatorSummary row{
      .name = estimator.name,
      .plugin = information.name,
      .parameters = estimator.parameters,
      // Nothing is known of rows made elsewhere.
      .bias = estimator.setup->observations() ? "unknown" : bias_name(nature.bias),
      .original = information.original,
      .defect = information.defect,
      .confidence = confidence,
      .variance_of = nature.averages ? "primary" : "secondary"};
  const Pool* pool = nullptr;
  for (const TestWork& work : run.tests) {
    for (std::size_t i = 0; i < work.pools.size(); ++i) {
      const Subject& side = work.outcome.question.subjects[i];
      const bool its = side.estimator == &estimator && side.purpose.empty() &&
                       work.pools[i]->setup() == estimator.setup;
      if (!its || work.outcome.secondaries(i) <= row.secondaries) continue;
      pool = work.pools[i].get();
      row.secondaries = work.outcome.secondaries(i);
    }
  }
  if (pool == nullptr) return row;
  row.primaries = pool->primaries();
  const Sample sample = pool->sample(row.secondaries);
  const Drawn* const drawn = std::get_if<Drawn>(&sample);
  if (drawn == nullptr) return row;
  const Summary& summary = drawn->summary();
  row.cost = cost_of(summary);
  const double averaged = nature.averages ? static_cast<double>(row.primaries) : 1;
  if (estimator.setup->image()) {
    row.channels.push_back(image_channel(*estimator.setup, summary, averaged, confidence));
    return row;
  }
  const std::vector<Channel> channels = estimator.setup->channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].diagnostic) continue;
    const stats::Moments moments = moments_of(estimator, run, *drawn, i);
    reports::EstimatorChannel channel{.name = channels[i].name,
                                      .mean = mean_of(moments, confidence),
                                      .variance = variance_of(moments, averaged, confidence)};
    if (channels[i].mean) channel.reference = *channels[i].mean;
    if (channels[i].variance) channel.reference_variance = *channels[i].variance;
    row.channels.push_back(channel);
  }
  return row;
}

/// A suite's tests in the order of its file, with adjusted p-values if the whole family ran.
std::vector<FamilyMember> members_of(const SuiteRun& run) {
  std::vector<FamilyMember> members;
  for (const Untested& each : run.untested) {
    members.push_back({record_of_untested(each, run), {position_of(*each.test, run.suite)}});
  }
  for (const TestWork& work : run.tests) {
    members.push_back(
        {record_of_test(work, run.suite.file), place_in_family(work.outcome, run.suite)});
  }
  std::ranges::sort(members, {}, [](const FamilyMember& each) { return each.place.position; });
  if (run.adjusted) adjust_p_values(members);
  return members;
}

/// Names the source of an estimator's rows if it cannot be read again. It is "standard input", or a
/// pipe or device in backquotes; else empty.
std::string passing_rows(const Suite& suite, const EstimatorEntry& entry) {
  const Value* const file = entry.plugin == "recorded" ? entry.parameters.find("file") : nullptr;
  if (file == nullptr) return "";
  const std::string& name = file->text();
  const std::string path = (std::filesystem::path(suite.folder) / name).string();
  if (!recorded::is_read_once(name) && !recorded::is_read_once(path)) return "";
  return name == "-" || name == "/dev/stdin" ? "standard input" : "`" + name + "`";
}

}  // namespace

reports::Tool this_tool() { return {.name = "assay", .version = version(), .commit = commit()}; }

reports::Environment this_environment(unsigned threads) {
  return {.compiler = fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__),
          .cpu = processor_name(),
          .isa = ray_instruction_set(),
          .threads = static_cast<int>(threads_of(threads))};
}

std::string utc_now() { return fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))); }

reports::Test record_of_test(const TestWork& work, const std::string& file) {
  const TestOutcome& outcome = work.outcome;
  const TestEntry& entry = *outcome.question.test;
  const Regions& regions = outcome.plan.regions[0];
  reports::Test test = head_of(entry, file);
  test.verdict = outcome.verdict;
  test.ok = test.verdict == test.expected;
  test.method = outcome.plan.method.name;
  const std::size_t worst = outcome.channels.empty() ? 0 : outcome.channels[0].index;
  test.forced = entry.method.has_value();
  test.null_hypothesis = null_hypothesis(outcome.question, worst);
  const bool distance = !outcome.channels.empty() && outcome.channels[0].evidence.distance;
  test.tail = distance ? "upper" : tail(regions);
  test.alpha = outcome.place.share.alpha;
  test.beta = outcome.place.share.beta;
  test.detect = regions.detect;
  test.allow = regions.allow;
  test.power = outcome.power;
  test.gates.assign(outcome.plan.gates.begin(), outcome.plan.gates.end());
  test.gates.insert(test.gates.end(), outcome.gates.begin(), outcome.gates.end());
  test.samples = samples_of(work);
  test.looks = looks_of(outcome, regions);
  if (const std::optional<DrawnTest> drawn = harness::drawn(work)) {
    // Red gates may have left no look to take a p-value of.
    const bool has_p = outcome.verdict != reports::Verdict::inconclusive || test.looks.empty() ||
                       std::ranges::any_of(test.looks, &std::optional<reports::Effect>::has_value,
                                           &reports::Look::effect);
    for (const ChannelOutcome& channel : outcome.channels) {
      test.channels.push_back(channel_of(channel, regions, has_p));
      test.channels.back().laws = empirical_laws(*drawn, channel.index);
    }
    if (!outcome.channels.empty()) test.detectable = outcome.channels.front().detectable;
    add_image(*drawn, test);
    add_cells(*drawn, test);
  }
  test.planned_looks = outcome.plan.looks.sizes;
  test.message = outcome.message;
  test.advice = outcome.advice;
  return test;
}

void add_note(reports::Record& record, const std::string& note) {
  record.note += (record.note.empty() ? "" : "; ") + note;
}

void note_retries(reports::Record& record) {
  std::vector<std::string> seeds;
  for (const reports::Suite& suite : record.suites) {
    for (const reports::Retry& each : suite.retries) {
      seeds.push_back(fmt::format("seed {} of `{}`", each.seed, each.estimator));
    }
  }
  if (seeds.empty()) return;
  add_note(record,
           fmt::format("{} {} started again: {}", seeds.size(),
                       seeds.size() == 1 ? "program failed and was" : "programs failed and were",
                       listed(seeds)));
}

void add_replay(const TestEntry& entry, const SuiteRun& run, const SuiteRuns& runs,
                const RunOptions& options, reports::Test& test) {
  for (const Source& source : sources_of(entry.claim)) {
    const auto& all = run.suite.estimators;
    const auto entry_of = std::ranges::find(all, source.estimator, &EstimatorEntry::name);
    const std::string from = entry_of == all.end() ? "" : passing_rows(run.suite, *entry_of);
    if (from.empty()) continue;
    test.no_replay = from + " cannot be read again: write it to a file";
    return;
  }
  const std::string command = "assay run";
  std::string line = options.command;
  if (line.starts_with(command)) {
    std::vector<std::string> files;
    for (const auto& each : runs) {
      if (options.assigns || each.get() == &run) files.push_back(each->suite.file);
    }
    line.insert(command.size(), option_words("", files));
  }
  if (line.empty()) return;
  line += option_words("--seed", {fmt::format("{}", run.seed)});
  if (!run.suite.file.empty()) line += option_words("--filter", {entry.id});
  test.replay = std::move(line);
}

reports::Test record_of_untested(const Untested& untested, const SuiteRun& run) {
  reports::Test test = head_of(*untested.test, run.suite.file);
  test.verdict = untested.verdict;
  test.ok = test.verdict == test.expected;
  test.message = untested.message;
  return test;
}

reports::FamilyResult place_in_family(const TestOutcome& outcome, const Suite& suite) {
  return {.position = position_of(*outcome.question.test, suite),
          .inside = outcome.place.inside,
          .weight = outcome.place.weight,
          .untested = outcome.question.channel_count() - outcome.channels.size(),
          .log_p = mapped(outcome.channels, [](const ChannelOutcome& channel) {
            return channel.decision.log_p_claimed;
          })};
}

void adjust_p_values(std::vector<FamilyMember>& suite) {
  std::vector<stats::WeightedLogP> entries;
  std::vector<reports::Channel*> channels;  // null where one has no p-value
  for (auto& [test, place] : suite) {
    if (!place.inside) continue;
    const bool is_tested = reports::is_evidence(test);
    for (std::size_t i = 0; i < place.log_p.size(); ++i) {
      entries.push_back({is_tested ? place.log_p[i] : stats::untested_log_p, place.weight});
      channels.push_back(&test.channels[i]);
    }
    entries.resize(entries.size() + place.untested, {stats::untested_log_p, place.weight});
    channels.resize(entries.size());
  }
  if (entries.empty()) return;
  const std::vector<double> adjusted = stats::weighted_holm(entries);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i] == nullptr) continue;
    channels[i]->p_adjusted = probability(adjusted[i]);
    channels[i]->log10_p_adjusted = log10_of(adjusted[i]);
  }
}

bool is_broken(const TestWork& work) {
  const TestOutcome& outcome = work.outcome;
  return outcome.decided && outcome.verdict != reports::Verdict::inconclusive &&
         outcome.verdict != outcome.question.test->expect;
}

reports::Record record_of(const SuiteRuns& runs, const RunOptions& options) {
  reports::Record record{.tool = this_tool(), .environment = this_environment(options.threads)};
  record.seed = runs.empty() ? options.seed.value_or(1) : runs.front()->seed;
  bool whole = true;
  std::vector<std::vector<reports::FamilyResult>> places(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& run = runs[i];
    reports::Suite suite{.name = run->suite.name,
                         .file = run->suite.file,
                         .about = run->suite.about,
                         .seed = run->seed,
                         .alpha = run->suite.alpha,
                         .beta = run->suite.beta};
    for (FamilyMember& each : members_of(*run)) {
      add_replay(run->suite.tests[each.place.position], *run, runs, options, each.test);
      suite.tests.push_back(std::move(each.test));
      places[i].push_back(std::move(each.place));
    }
    suite.statements = statements_of(run->suite, suite.tests);
    // The clock affects their numbers.
    suite.timed = std::ranges::any_of(run->tests, [](const TestWork& work) {
      return work.outcome.plan.method.keeps == Keeps::blocks || work.outcome.place.in_seconds;
    });
    for (const auto& [name, estimator] : run->estimators) {
      const auto* const rendered = dynamic_cast<const foreign::Rendered*>(estimator.setup.get());
      if (rendered == nullptr) continue;
      for (foreign::Retry& each : rendered->retries()) {
        suite.retries.push_back({name, each.seed, each.retry, std::move(each.reason)});
      }
    }
    whole = whole && run->adjusted;
    for (const PreparedEstimator* each : run->used) {
      suite.estimators.push_back(summarise(*each, *run));
    }
    record.suites.push_back(std::move(suite));
  }
  if (!whole) record.note = partial_note;
  if (options.shard) add_shard(runs, options, std::move(places), record);
  note_retries(record);
  return record;
}

}  // namespace assay::harness
