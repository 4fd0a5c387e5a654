#include "reports/words/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "reports/record/statements.h"
#include "reports/words/effect.h"
#include "reports/words/evidence.h"
#include "reports/words/kill_matrix.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/statement_text.h"
#include "reports/words/summary.h"

namespace assay::reports {
namespace {

bool is_finite(const Number& value) { return value && std::isfinite(*value); }

/// "+0.06 % to +2.1 %", "at least +0.12 %"; empty where there is no interval.
std::string range(const Effect& effect) {
  const auto end = [&](const Number& value) { return theta_text(*value, effect); };
  if (is_finite(effect.low) && is_finite(effect.high))
    return fmt::format("{} to {}", end(effect.low), end(effect.high));
  if (is_finite(effect.low)) return "at least " + end(effect.low);
  return is_finite(effect.high) ? "at most " + end(effect.high) : std::string();
}

std::string bracket(const Effect& effect) {
  const std::string text = range(effect);
  return text.empty() ? text : fmt::format(" ({})", text);
}

/// The sides of a claim about its relation; the second is empty where there is no relation.
std::pair<std::string, std::string> sides(const std::string& claim) {
  const std::string relation = relation_of(claim);
  const std::string between = " " + relation + " ";
  const std::size_t at = relation.empty() ? std::string::npos : claim.find(between);
  if (at == std::string::npos) return {claim, ""};
  return {claim.substr(0, at), claim.substr(at + between.size())};
}

/// "mean(area) is 1.07 % above analytic (+0.06 % to +2.1 %)".
std::string found(const Test& test, const Effect& effect) {
  const double theta = *effect.estimate;
  const auto [left, right] = sides(test.claim);
  const bool signed_effect =
      is_ratio(effect) || effect.quantity.find("difference") != std::string::npos;
  const bool of_image = test.image.has_value();
  const std::string size = size_text(theta, effect);
  if (right.empty() || !signed_effect || of_image || relation_of(test.claim) == "within" ||
      !std::isfinite(theta)) {
    return fmt::format("{} is {}{}", effect_name(effect), theta_text(theta, effect),
                       bracket(effect));
  }
  if (theta == 0) return fmt::format("{} equals {}{}", left, right, bracket(effect));
  const std::string text = theta_text(theta, effect);
  if (text.starts_with("×"))
    return fmt::format("{} is {} {}{}", left, text, right, bracket(effect));
  return fmt::format("{} is {} {} {}{}", left, size, theta > 0 ? "above" : "below", right,
                     bracket(effect));
}

/// "x 152-183, y 136-167 of red".
std::string pixels(const Image& image, const ImageFinding& finding) {
  const auto span = [](char axis, std::uint64_t first, std::uint64_t count) {
    return count < 2 ? fmt::format("{} {}", axis, first)
                     : fmt::format("{} {}-{}", axis, first, first + count - 1);
  };
  const bool whole = finding.width == image.width && finding.height == image.height;
  const std::string place =
      whole ? "the whole image"
            : span('x', finding.x, finding.width) + ", " + span('y', finding.y, finding.height);
  return image.components.size() > 1 ? place + " of " + finding.component : place;
}

std::string found_in_image(const Image& image) {
  const ImageFinding& winner = image.winner;
  if (winner.place.empty()) return {};
  if (winner.effect && winner.effect->estimate) {
    Effect size = *winner.effect;
    const bool dark = *size.estimate < 0;
    if (dark) {
      std::swap(size.low, size.high);
      for (Number* each : {&size.estimate, &size.low, &size.high}) {
        if (*each) *each = -**each;
      }
    }
    // The words have the sign.
    std::string interval = bracket(size);
    if (size.low.value_or(0) >= 0) std::erase(interval, '+');
    return fmt::format("{} is {} too {}{}", pixels(image, winner), size_text(*size.estimate, size),
                       dark ? "dark" : "bright", interval);
  }
  if (winner.statistic == "alternating") return "the whole image differs with alternating signs";
  if (winner.statistic != "window") {
    return fmt::format("{}: {}", pixels(image, winner), winner.statistic);
  }
  return fmt::format("{} is too {}", pixels(image, winner),
                     winner.z.value_or(0) > 0 ? "bright" : "dark");
}

/// True where the interval leaves out all that is claimed or allowed.
bool leaves_claim_out(const Test& test, const Effect& effect) {
  const double allow = test.allow.value_or(0);
  return relation_of(test.claim) == "==" && ((is_finite(effect.low) && *effect.low > allow) ||
                                             (is_finite(effect.high) && *effect.high < -allow));
}

/// True where the interval lies within the margin on both sides.
bool lies_within(const Effect& effect, const Number& margin) {
  return margin && is_finite(effect.low) && is_finite(effect.high) && *effect.low > -*margin &&
         *effect.high < *margin;
}

std::string sentence_of(const Test& test, const Effect& effect, const std::string& margin) {
  if (test.verdict == Verdict::skipped) return "It was not run.";
  if (!is_evidence(test)) return headline(test);
  const bool differs = test.image && test.verdict == Verdict::fail;
  std::string text = differs ? found_in_image(*test.image) : std::string();
  if (text.empty() && effect.estimate) text = found(test, effect);
  if (text.empty()) return headline(test);
  if (!margin.empty()) text += fmt::format("; you asked to catch {}", margin);
  text += ".";
  if (test.verdict == Verdict::pass && leaves_claim_out(test, effect)) {
    text += lies_within(effect, test.detect)
                ? fmt::format(" It is off, but by less than {}.", margin)
                : " Its range leaves the claim out, which at this test's level is no rejection.";
  }
  return text;
}

/// "1 in 17,000" of a p-value; empty where there is none.
std::string one_in(const Number& log10_p) {
  if (!log10_p || std::isnan(*log10_p)) return {};
  constexpr double shown = -9;
  if (*log10_p < shown) return "less than 1 in a billion";
  const double count = std::pow(10, -*log10_p);
  if (count < 2) return "more than 1 in 2";
  const double step = std::pow(10, std::floor(std::log10(count)) - 1);
  return "1 in " + in_commas(std::round(count / step) * step);
}

std::optional<KillDisplay> kills(const Suite& suite) {
  const KillMatrix matrix = kill_matrix(suite);
  if (!is_worth_showing(matrix)) return std::nullopt;
  KillDisplay shown{.methods = matrix.methods,
                    .totals = kill_totals(suite, matrix),
                    .legend = kill_matrix_legend};
  for (const KillRow& row : matrix.rows) {
    const EstimatorSummary& mutant = suite.estimators[row.mutant];
    shown.rows.push_back({.mutant = mutant.name, .defect = mutant.defect});
    for (const std::optional<KillCell>& cell : row.cells) {
      if (!cell) {
        shown.rows.back().cells.emplace_back();
        continue;
      }
      shown.rows.back().cells.push_back(
          KillCellDisplay{.test = suite.tests[cell->test].id,
                          .text = short_text(suite, *cell),
                          .sentence = sentence(suite, *cell),
                          .killed = cell->fate == Fate::killed || cell->fate == Fate::broken});
    }
  }
  return shown;
}

std::set<std::string> estimators_of(const Test& test) {
  std::set<std::string> names;
  for (const Sample& sample : test.samples) names.insert(sample.estimator);
  return names;
}

}  // namespace

const char* to_string(Standing standing) {
  constexpr const char* names[] = {"broken", "undecided", "holds", "caught", "not run"};
  return names[static_cast<int>(standing)];
}

Standing standing(const Test& test) {
  // In the order of outcomes.
  const Standing standings[] = {test.expected == Verdict::pass ? Standing::holds : Standing::caught,
                                Standing::broken, Standing::undecided, Standing::not_run};
  return standings[static_cast<int>(outcome(test))];
}

TestDisplay display(const Test& test) {
  const Effect effect = deciding_channel(test).effect;
  const bool shown = is_evidence(test) && effect.estimate.has_value();
  TestDisplay words{.standing = to_string(standing(test)),
                    .verdict = verdict_text(test),
                    .place = place(test),
                    .cost = cost_text(total_cost(test)),
                    .facts = facts(test)};
  if (test.detect) words.margin = margin_text(*test.detect, effect);
  words.sentence = sentence_of(test, effect, words.margin);
  if (shown) {
    words.effect = theta_text(*effect.estimate, effect);
    words.interval = range(effect);
  }
  if (is_evidence(test) && !is_proof(test)) words.chance = one_in(worst_channel(test).log10_p);
  return words;
}

SuiteDisplay display(const Suite& suite) {
  SuiteDisplay words{.levels = levels_text(suite), .kills = kills(suite)};
  for (const Statement& statement : suite.statements) {
    words.statements.push_back({.answer = whole_answer(suite, statement),
                                .holds = findings(suite, statement.holds),
                                .fails = findings(suite, statement.fails)});
  }
  return words;
}

std::vector<Suspect> suspects(const Suite& suite) {
  std::map<std::string, int> claims;
  std::vector<const Test*> broken;
  for (const Test& test : suite.tests) {
    for (const std::string& name : estimators_of(test)) ++claims[name];
    if (standing(test) == Standing::broken) broken.push_back(&test);
  }
  std::vector<Suspect> all;
  while (!broken.empty()) {
    std::map<std::string, int> count;
    for (const Test* test : broken) {
      for (const std::string& name : estimators_of(*test)) ++count[name];
    }
    // A tie goes to the estimator whose claims are broken most often.
    const auto worst =
        std::max_element(count.begin(), count.end(), [&](const auto& a, const auto& b) {
          return std::pair(a.second, -claims[a.first]) < std::pair(b.second, -claims[b.first]);
        });
    Suspect suspect{.suite = suite.name};
    if (worst == count.end()) {
      suspect.name = broken.front()->name;
      suspect.tests = {broken.front()->id};
      broken.erase(broken.begin());
    } else {
      suspect.name = worst->first;
      std::erase_if(broken, [&](const Test* test) {
        const bool shared = estimators_of(*test).contains(suspect.name);
        if (shared) suspect.tests.push_back(test->id);
        return shared;
      });
      suspect.sentence =
          fmt::format("{} of its {} broken", worst->second,
                      counted(static_cast<std::uint64_t>(claims[suspect.name]), "claim", "claims"));
    }
    all.push_back(std::move(suspect));
  }
  return all;
}

RecordDisplay display(const Record& record) {
  const std::string alarm = alarm_count(record);
  RecordDisplay words{
      .verdict = tally_sentence(tally(record)) + (alarm.empty() ? "" : "; " + alarm),
      .counts = verdict_counts(record),
      .rates = error_rates(record),
      .seed = fmt::format("{}", record.seed)};
  for (const Suite& suite : record.suites) {
    for (Suspect& suspect : suspects(suite)) words.suspects.push_back(std::move(suspect));
  }
  std::stable_sort(
      words.suspects.begin(), words.suspects.end(),
      [](const Suspect& a, const Suspect& b) { return a.tests.size() > b.tests.size(); });
  if (record.ledger.file.empty()) return words;
  words.ledger = ledger_title(record.ledger);
  words.quiet = quiet_sentence(record.ledger);
  words.notes = ledger_notes(record.ledger);
  for (const LedgerSeries& series : record.ledger.series) {
    words.series.push_back({.name = series_name(record.ledger, series),
                            .sentence = series_sentence(series),
                            .alarm = alarm_sentence(series)});
  }
  return words;
}

}  // namespace assay::reports
