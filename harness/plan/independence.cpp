#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimators/ready_made.h"
#include "harness/plan/plan.h"
#include "harness/theta/ask.h"
#include "stats/gates/copies.h"
#include "stats/gates/dependence.h"

namespace assay::harness {
namespace {

using stats::GateState;

// In fewer rows the gates of independence miss strong dependence.
constexpr std::size_t fewest_in_order_to_tell = 100;
// No method of means keeps its level with fewer rows: nobody is told to force one.
constexpr std::size_t fewest_to_force = 20;
// Student's t on fewer batch means is off (Glynn and Iglehart 1990).
constexpr std::size_t fewest_batches = 20;

/// One channel of a recorded subject, as far as the test reads it.
struct Rows {
  std::size_t subject;
  std::size_t channel;
  std::string label;
  std::span<const double> values;
};

std::vector<Rows> rows_of(const Question& question, const Pilots& pilots, std::uint64_t count) {
  std::vector<Rows> all;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const Pilot* pilot = pilot_of(side, pilots);
    if (!is_recorded(side) || pilot == nullptr || pilot->values(0).empty()) continue;
    for (std::size_t channel = 0; channel < side.channels.size(); ++channel) {
      const ChannelData data = pilot_channel(side, *pilot, channel);
      const std::size_t used = std::min<std::uint64_t>(data.values.size(), count);
      const bool finite =
          std::ranges::all_of(data.values, [](double value) { return std::isfinite(value); });
      if (!finite || used < fewest_in_order || is_constant(side, channel, data.moments)) continue;
      all.push_back({.subject = subject,
                     .channel = channel,
                     .label = "rows of " + side.name_of(channel),
                     .values = data.values.first(used)});
    }
  }
  return all;
}

/// Advice on the rows that suffice of a chain with this autocorrelation time; "" if there are as
/// many.
std::string enough_of_a_chain(const Question& question, std::size_t rows, double time) {
  const auto apart = static_cast<std::size_t>(std::ceil(10 * time));
  const std::size_t needed = apart * fewest_in_order_to_tell;
  const std::string more = rows < needed ? fmt::format("draw {} rows and ", needed) : "";
  if (!question.is().batches_serve) return fmt::format("{}keep one row in {}", more, apart);
  const std::optional<std::string>& forced = question.test->method;
  if (forced && !find_method(question, *forced).is.of_batches) {
    return "leave `test` out: Assay then averages batches of enough rows";
  }
  if (question.test->claim.relation == Relation::within) {
    return fmt::format("{}give means of {} successive rows each", more, apart);
  }
  // A half more: another sample's estimate may be larger.
  const std::size_t enough = fewest_batches * std::max(apart, fewest_batches) * 3 / 2;
  if (rows >= enough) return "";
  return fmt::format("at least {} rows, which Assay then averages in batches", enough);
}

/// `at_a_lag`: values some steps apart show the dependence, not neighbours.
Reason dependent(const Question& question, const Rows& rows, bool at_a_lag) {
  const double time = std::max(1.0, stats::autocorrelation_time(rows.values));
  const stats::LaggedCorrelation worst = stats::worst_of(stats::lagged_correlations(rows.values));
  if (at_a_lag && worst.correlation > 0 && static_cast<double>(worst.lag) > time) {
    return Reason::advising(
        fmt::format("the {} are not independent: those {} apart have a rank correlation of {:.2g}, "
                    "as if that many chains took turns; ",
                    rows.label, worst.lag, worst.correlation),
        "give one row per chain");
  }
  if (!(time > 1)) {
    const stats::LaggedCorrelation any =
        stats::worst_of(stats::lagged_correlations(rows.values, 1));
    return Reason::advising(
        fmt::format(
            "the {} are not independent: those {} apart have a rank correlation of {:.2g}; ",
            rows.label, any.lag, any.correlation),
        "give the mean of rows that were drawn together as one row");
  }
  constexpr double fewest_of_a_chain = 10;
  const double worth = static_cast<double>(rows.values.size()) / time;
  const std::string why = fmt::format(
      "the {} are not independent: {} of them are worth about {:.0f} independent ones; ",
      rows.label, rows.values.size(), worth);
  if (worth < fewest_of_a_chain) {
    const bool several = question.subjects[0].channels.size() > 1;
    return Reason::advising(
        why, std::string(several ? "if this column counts the rows, name another; " : "") +
                 "give rows unsorted, as they were drawn; a slow chain needs more rows");
  }
  const std::string or_enough = enough_of_a_chain(question, rows.values.size(), time);
  return Reason::advising(
      why, "give one row per chain" + (or_enough.empty() ? "" : ", or " + or_enough));
}

std::string from_to(std::size_t first, std::size_t length) {
  return fmt::format("{} to {}", first + 1, first + length);
}

Reason repeated(const Rows& rows, const stats::RepeatedRun& again) {
  return Reason::advising(fmt::format("of the {} those from {} repeat those from {} bit for bit: "
                                      "they are not new observations; ",
                                      rows.label, from_to(again.second, again.length),
                                      from_to(again.first, again.length)),
                          "give each run of the program that writes them a seed of its own");
}

[[noreturn]] void refuse_pair(const Question& question, const Subject& first, const Subject& second,
                              const std::string& why) {
  refuse(
      question.test->claim.left.where,
      "`{}` and `{}` are not independent samples: {}; give every run of either side its own seed{}",
      first.estimator->name, second.estimator->name, why,
      question.theta->of_pairs(question) == nullptr
          ? ""
          : ", or compare pairs of one seed with " + written_key(*question.test, "paired", "true"));
}

void refuse_shared_pictures(const Question& question, std::uint64_t count) {
  for (const Subject& first : question.subjects) {
    for (const Subject& second : std::span(&first + 1, std::to_address(question.subjects.end()))) {
      const recorded::Pictures* const one = first.setup->pictures();
      const recorded::Pictures* const two = second.setup->pictures();
      if (!one || !two) continue;
      if (const auto files = one->shared_with(*two, count)) {
        refuse_pair(question, first, second,
                    fmt::format("`{}` and `{}` are the same picture, bit for bit", files->first,
                                files->second));
      }
    }
  }
}

void refuse_shared_rows(const Question& question, const Rows& one, const Rows& two) {
  const Subject& first = question.subjects[one.subject];
  const Subject& second = question.subjects[two.subject];
  if (const auto run = stats::common_run(one.values, two.values)) {
    refuse_pair(question, first, second,
                fmt::format("rows {} of `{}` are rows {} of `{}`, bit for bit",
                            from_to(run->first, run->length), first.setup->data_file(),
                            from_to(run->second, run->length), second.setup->data_file()));
  }
  const std::optional<double> r = stats::correlation_of_pairs(one.values, two.values);
  if (!r) return;
  refuse_pair(
      question, first, second,
      fmt::format("row by row they have a rank correlation of {:.2g}; if their seeds are the "
                  "same, write the differences to one file and claim that their mean is 0",
                  *r));
}

/// Why rows are too few to show their independence; "" if they are enough.
Reason too_few_to_tell(TestOutcome& test, const Pilots& pilots, std::uint64_t count) {
  Reason reason;
  for (const Subject& side : test.question.subjects) {
    const Pilot* pilot = pilot_of(side, pilots);
    if (!is_recorded(side) || side.setup->image() || pilot == nullptr) continue;
    const ChannelData first = pilot_channel(side, *pilot, 0);
    // Constants have gates of their own. A single row is no constant.
    const bool constant = first.values.size() > 1 && !(first.moments.m2 > 0);
    if (first.values.empty() || constant) continue;
    const std::uint64_t rows = std::min<std::uint64_t>(first.values.size(), count);
    test.plan.gates.push_back(gate_of("rows to show independence of " + side.estimator->name,
                                      static_cast<double>(rows), fewest_in_order_to_tell,
                                      rows < fewest_in_order_to_tell ? "red" : "green"));
    if (rows >= fewest_in_order_to_tell || !reason.empty()) continue;
    // A forced method runs unchecked.
    const std::string forced =
        rows < fewest_to_force
            ? ""
            : fmt::format("; if they are independent{}, add {}",
                          test.question.is().batches_serve ? " and near normal" : "",
                          written_key(*test.question.test, "test", test.plan.method.name));
    const std::uint64_t there = side.setup->observations().value_or(rows);
    const char* const key = test.question.test->budget ? "budget" : "secondaries";
    const bool limited = rows < there;
    const std::string mend = limited ? fmt::format("give a larger `{}`", key)
                                     : fmt::format("give {} rows", fewest_in_order_to_tell);
    reason = {fmt::format("`{}` has {} row{}{}, and a check of independence needs {}: {}{}",
                          side.estimator->name, there, there == 1 ? "" : "s",
                          limited ? fmt::format(", of which `{}` allows {}", key, rows) : "",
                          fewest_in_order_to_tell, mend, forced),
              reports::Advice{.words = mend}};
  }
  return reason;
}

/// Allows for a dependence of rows that is too weak for a gate.
void allow_for_dependence(const std::vector<Rows>& all, Plan& plan) {
  for (const Rows& rows : all) {
    const double factor = stats::allowance_for_dependence(rows.values);
    if (!(factor > 1)) continue;
    plan.row_allowances[{rows.subject, rows.channel}] = factor;
    plan.gates.push_back(gate_of("variance of the mean, allowed for dependence", factor, 1, "amber",
                                 ", " + rows.label));
  }
}

}  // namespace

void require_independent_sides(const Question& question, const Pilots& pilots,
                               std::uint64_t count) {
  if (question.subjects.size() < 2 || question.is().of_pairs) return;
  refuse_shared_pictures(question, count);
  const std::vector<Rows> all = rows_of(question, pilots, count);
  for (const Rows& one : all) {
    for (const Rows& two : all) {
      if (one.subject < two.subject && one.channel == two.channel) {
        refuse_shared_rows(question, one, two);
      }
    }
  }
}

void judge_independence(TestOutcome& test, const Pilots& pilots, std::uint64_t count) {
  const Question& question = test.question;
  Plan& plan = test.plan;
  const bool forced = question.test->method.has_value();
  Reason reason = too_few_to_tell(test, pilots, count);
  if (forced || !plan.invalid.empty()) reason = {};
  const std::vector<Rows> all = rows_of(question, pilots, count);
  const bool batches =
      question.is().batches_serve && (!forced || plan.method.is.of_batches) &&
      question.test->claim.relation != Relation::within &&
      std::ranges::all_of(all, [](const Rows& each) {
        return each.values.size() / stats::sufficient_batch(each.values) >= fewest_batches;
      });
  bool answered = false;
  for (const Rows& rows : all) {
    if (const auto again = stats::repeated_run(rows.values)) {
      plan.gates.push_back(gate_of("longest repetition", static_cast<double>(again->length), 0,
                                   "red", ", " + rows.label));
      if (reason.empty()) reason = repeated(rows, *again);
    }
    std::vector<stats::Gate> gates{stats::lag_one_gate(rows.values),
                                   stats::lagged_gate(rows.values), stats::batch_gate(rows.values)};
    const bool red = std::ranges::any_of(
        gates, [](const stats::Gate& gate) { return gate.state == GateState::red; });
    const bool averaged = red && batches;
    answered = answered || averaged;
    if (red && !averaged && reason.empty()) {
      reason = dependent(question, rows,
                         gates[1].state == GateState::red && gates[0].state != GateState::red);
    }
    for (stats::Gate& gate : gates) {
      if (averaged && gate.state == GateState::red) gate.state = GateState::amber;
      plan.gates.push_back(gate_of(gate, ", " + rows.label));
    }
  }
  if (!reason.empty()) {
    plan.invalid = reason;
  } else if (forced) {
    return;
  } else if (answered) {
    plan.method = find_method(question, "batch-means");
    plan.caution = "successive rows are correlated: the interval is from means of batches";
    // Batches answer what spoke against single rows; it still speaks against a drawn side.
    if (std::ranges::all_of(question.subjects, is_recorded)) {
      plan.invalid = {};
    }
  } else if (question.is().batches_serve && !plan.method.is.exact) {
    allow_for_dependence(all, plan);
  }
}

stats::Moments as_tested(const Plan& plan, std::size_t subject, std::size_t channel,
                         std::span<const double> values, stats::Moments moments) {
  // Constants are judged by themselves, and have no order.
  if (!(moments.m2 > 0) || values.size() < fewest_in_order) return moments;
  if (plan.method.is.of_batches) return stats::batch_means(values, stats::sufficient_batch(values));
  const auto allowance = plan.row_allowances.find({subject, channel});
  if (allowance == plan.row_allowances.end()) return moments;
  const double factor = allowance->second;
  moments.m2 *= factor;
  moments.m3 *= factor * std::sqrt(factor);
  moments.m4 *= factor * factor;
  return moments;
}

bool shows_order(const Subject& subject) {
  return !is_recorded(subject) && !subject.setup->image();
}

void judge_order(const Subject& subject, const Drawn& drawn, std::vector<Gate>& gates,
                 Reason& invalid) {
  if (!shows_order(subject)) return;
  for (const std::size_t channel : subject.channels.all()) {
    for (const stats::Gate& gate : drawn.order_gates(channel)) {
      if (gate.state != stats::GateState::red) continue;
      gates.push_back(gate_of(gate, ", " + subject.estimator->name));
      if (!invalid.empty()) continue;
      invalid = fmt::format(
          "the observations of `{}` are not independent: {}; an observation must depend on its own "
          "random numbers alone, not on what was drawn before it or beside it",
          subject.estimator->name, red_gates({gates.back()}));
    }
  }
}

}  // namespace assay::harness
