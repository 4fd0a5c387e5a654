#include "reports/words/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cctype>
#include <cmath>
#include <set>
#include <tuple>

#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/statements.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

std::string of_claims(int some, int total, const char* of = "of") {
  return fmt::format("{} {} {}", some, of,
                     counted(static_cast<std::uint64_t>(total), "claim", "claims"));
}

/// A planted bug that passed.
bool is_missed(const Test& test) {
  return test.expected == Verdict::fail && test.verdict == Verdict::pass;
}

/// The interval, if it says more than the estimate.
std::string wider_range(const Effect& effect) {
  const std::string text = range_text(effect);
  return text == theta_text(*effect.estimate, effect) ? "" : text;
}

std::string bracket(const Effect& effect) {
  const std::string text = wider_range(effect);
  return text.empty() ? text : fmt::format(" ({})", text);
}

/// "mean(area) is 1.07 % above analytic".
std::string found(const Test& test, const Effect& effect) {
  const double theta = *effect.estimate;
  const auto [left, relation, right] = sides_of(test.claim);
  const bool signed_effect =
      is_ratio(effect) || effect.quantity.find("difference") != std::string::npos;
  if (right.empty() || !signed_effect || test.image || relation == "within" ||
      !std::isfinite(theta))
    return fmt::format("{} is {}", effect_name(effect), theta_text(theta, effect));
  if (theta == 0) return fmt::format("{} equals {}", left, right);
  if (is_factor(effect)) return fmt::format("{} is {} times {}", left, factor_text(theta), right);
  return fmt::format("{} is {} {} {}", left, size_text(theta, effect),
                     theta > 0 ? "above" : "below", right);
}

std::string found_in_image(const Image& image) {
  const ImageFinding& winner = image.winner;
  if (winner.effect && winner.effect->estimate) {
    Effect size = *winner.effect;
    const bool dark = *size.estimate < 0;
    if (dark) std::swap(size.low, size.high);
    for (Number* each : {&size.estimate, &size.low, &size.high}) {
      if (dark && *each) *each = -**each;
    }
    // The words have the sign.
    std::string interval = bracket(size);
    if (size.low.value_or(0) >= 0) std::erase(interval, '+');
    const char* const weighted = winner.width * winner.height == 1 ? "" : ", weighted by noise";
    return fmt::format("{} is {} too {}{}{}", winner.place, size_text(*size.estimate, size),
                       dark ? "dark" : "bright", interval,
                       winner.others.empty() ? "" : weighted + ("; there " + winner.others));
  }
  if (winner.statistic == "alternating") return "the whole image differs with alternating signs";
  if (winner.statistic != "window") return fmt::format("{}: {}", winner.place, winner.statistic);
  return fmt::format("{} is too {}", winner.place, winner.z.value_or(0) > 0 ? "bright" : "dark");
}

/// A pass whose interval leaves out all that is claimed or allowed says so.
std::string exclusion_of_claim(const Test& test, const Effect& effect, const std::string& margin) {
  const double allow = test.allow.value_or(0), detect = test.detect.value_or(0);
  if (test.verdict != Verdict::pass || sides_of(test.claim).relation != "==" ||
      !(lies_above(effect, allow) || lies_below(effect, -allow)))
    return "";
  if (lies_above(effect, -detect) && lies_below(effect, detect))
    return fmt::format(" It is off, but by less than {}.", margin);
  return test.image ? " No place differs beyond noise, but all pixels together do."
                    : " That is not enough evidence against the claim.";
}

/// Words without the advice in them, which is a step of its own.
std::string without_advice(std::string words, const Test& test) {
  const std::string advice = test.advice && test.advice->key.empty() ? test.advice->words : "";
  const std::size_t at = advice.empty() ? std::string::npos : words.rfind(advice);
  if (at == std::string::npos || at < 2) return words;
  return words.erase(at - 2, advice.size() + 2);  // with "; " or ": "
}

std::string sentence_of(const Test& test, const Effect& effect, const std::string& margin) {
  if (test.verdict == Verdict::skipped) return "It was not run.";
  if (!is_evidence(test)) return without_advice(headline(test), test);
  std::string text = is_told_by_place(test) ? found_in_image(*test.image) : std::string();
  if (text.empty() && effect.estimate) text = found(test, effect) + bracket(effect);
  if (text.empty()) return headline(test);
  if (test.channels.size() > 1) text += " in channel " + deciding_channel(test).name;
  // A fail was noticed, whatever its size.
  if (!margin.empty() && test.verdict != Verdict::fail)
    text += fmt::format("; {}{} must be caught", margin, test.image ? " over the whole image" : "");
  return text + "." + exclusion_of_claim(test, effect, margin);
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

/// "4 runs in 100": a rate in two digits, of the fewest runs that a whole number is meant of.
std::string in_many(double rate, const char* noun) {
  double runs = 100;
  const auto whole = [&] { return std::abs(rate * runs - std::round(rate * runs)) < 1e-6; };
  while (rate * runs < 1 || (!whole() && rate * runs < 10)) runs *= 10;
  const double some = whole() ? std::round(rate * runs) : std::ceil(rate * runs);
  return fmt::format("{:.0f} {}{} in {}", some, noun, some == 1 ? "" : "s", in_commas(runs));
}

/// The command with this option instead of its own of the same name.
std::string with_option(std::string command, const std::string& option) {
  const std::string name = " " + option.substr(0, option.find(' ') + 1);
  const std::size_t at = command.find(name);
  if (at == std::string::npos) return command + " " + option;
  const std::size_t end = std::min(command.find(' ', at + name.size()), command.size());
  return command.replace(at + 1, end - at - 1, option);
}

/// The estimator on the claim's left side, which is held against the right one; the test's name if
/// it has no sample.
std::string subject_of(const Test& test) {
  std::vector<std::string> words;
  boost::split(words, sides_of(test.claim).right, boost::is_any_of("(). *"));
  const auto subject = std::ranges::find_if(test.samples, [&](const Sample& sample) {
    return std::ranges::count(words, sample.estimator) == 0;
  });
  return subject == test.samples.end() ? test.name : subject->estimator;
}

}  // namespace

std::string tally_sentence(Standings count) {
  int total = 0;
  for (const auto& [standing, some] : count) total += some;
  const int skipped = count[Standing::not_run];
  if (total == 0) return "No claim was tested";
  std::string text;
  for (const auto& [standing, words] : {std::pair{Standing::broken, "broken"},
                                        {Standing::no_verdict, "without a verdict"},
                                        {Standing::undecided, "undecided"}}) {
    const int some = count[standing];
    if (some > 0)
      text +=
          text.empty() ? of_claims(some, total) + " " + words : fmt::format(", {} {}", some, words);
  }
  if (!text.empty()) return text;
  if (total == 1) return skipped > 0 ? "The claim was not tested" : "The claim is as it should be";
  if (skipped == total) return fmt::format("None of {} claims was tested", total);
  if (skipped > 0)
    return fmt::format("{} as they should be, {} not tested", of_claims(total - skipped, total),
                       skipped);
  return fmt::format("All {} claims are as they should be", total);
}

std::string run_sentence(const Record& record) {
  std::string tally = tally_sentence(standings(record));
  if (const auto count = static_cast<std::uint64_t>(alarms(record.ledger)); count > 0) {
    tally[0] = static_cast<char>(std::tolower(tally[0]));
    tally = fmt::format("{} over all nights. In this run: {}",
                        counted(count, "ledger alarm", "ledger alarms"), tally);
  }
  if (!record.shard) return tally;
  return fmt::format("Shard {} of {}: {}", record.shard->index, record.shard->count, tally);
}

std::string false_alarms(double alpha) {
  if (!(alpha > 0)) return {};
  if (alpha >= 1) return "False alarms: in any run, as the suites' alphas add up to 1 or more.";
  return fmt::format("False alarms: at most {}.", in_many(alpha, "run"));
}

std::string false_alarms(const Record& record) {
  double alpha = 0;
  for (const Suite& suite : record.suites) alpha += suite.tests.empty() ? 0 : suite.alpha;
  return false_alarms(alpha);
}

std::string error_rates(const Record& record) {
  double beta = 0;
  for (const Suite& suite : record.suites) {
    for (const Test& test : suite.tests) beta = std::max(beta, test.detect ? suite.beta : 0);
  }
  if (!(beta > 0 && beta < 1)) return false_alarms(record);
  return fmt::format("{} Misses: at most {} of those that are wrong by `detect`.",
                     false_alarms(record), in_many(beta, "claim"));
}

std::string counts_text(Standings count) {
  int total = 0;
  for (const auto& [standing, some] : count) total += some;
  const int held = count[Standing::holds], caught = count[Standing::caught];
  const bool well = held + caught == total;
  const std::pair<int, const char*> all[] = {
      {well ? held : 0, held == 1 ? "holds" : "hold"},
      {well ? caught : 0, caught == 1 ? "planted bug caught" : "planted bugs caught"},
      {count[Standing::broken], "broken"},
      {count[Standing::no_verdict], "without a verdict"},
      {count[Standing::undecided], "undecided"},
      {count[Standing::not_run], "not run"},
      {well ? 0 : held + caught, "ok"}};
  std::vector<std::string> parts;
  for (const auto& [some, words] : all) {
    if (some > 0) parts.push_back(fmt::format("{} {}", some, words));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

const char* to_string(Standing standing) {
  constexpr const char* names[] = {"broken", "no verdict", "undecided",
                                   "holds",  "caught",     "not run"};
  return names[static_cast<int>(standing)];
}

Standings standings(const Suite& suite) {
  Standings count;
  for (const Test& test : suite.tests) ++count[standing(test)];
  return count;
}

Standings standings(const Record& record) {
  Standings count;
  for (const Test* test : tests_of(record)) ++count[standing(*test)];
  return count;
}

std::string meaning(const Test& test) {
  if (is_missed(test)) return "";
  if (standing(test) == Standing::caught) return "The planted bug was caught.";
  if (test.verdict == Verdict::pass && is_proof(test)) return "The claim is shown.";
  constexpr const char* meanings[] = {
      "Nothing speaks against the claim.",
      "The claim is wrong.",
      "The observations do not suffice to say whether the claim holds.",
      "Nothing was decided, because an assumption of the test does not hold.",
      "Nothing was decided, because drawing failed.",
      "The claim was not tested."};
  return meanings[static_cast<int>(test.verdict)];
}

TestDisplay display(const Test& test) {
  const Effect effect = deciding_channel(test).effect;
  const Effect shown = effect_in_sentence(test);
  TestDisplay words{.standing = to_string(standing(test)),
                    .verdict = verdict_text(test),
                    .meaning = meaning(test),
                    .place = place(test),
                    .steps = steps(test),
                    .facts = facts(test)};
  if (test.detect) words.margin = margin_text(*test.detect, effect);
  words.sentence = sentence_of(test, effect, words.margin);
  if (shown.estimate) {
    words.effect = (is_root_mean_square(shown) ? "RMS " : "") + theta_text(*shown.estimate, shown);
    words.interval = wider_range(shown);
  }
  if (is_evidence(test) && !is_proof(test)) words.chance = one_in(headline_p(test).log10_p);
  return words;
}

SuiteDisplay display(const Suite& suite) {
  SuiteDisplay words{.counts = counts_text(standings(suite)), .levels = levels_text(suite)};
  if (KillMatrix matrix = kill_matrix(suite); is_worth_showing(matrix))
    words.kills = std::move(matrix);
  for (const Statement& statement : suite.statements) {
    words.statements.push_back({.answer = whole_answer(suite, statement),
                                .holds = findings(suite, statement.holds),
                                .fails = findings(suite, statement.fails)});
  }
  return words;
}

std::vector<Suspect> suspects(const Suite& suite) {
  const std::string broken = to_string(Standing::broken);
  std::map<std::string, int> claims;
  std::map<std::string, double> least;       // log10 of p
  std::map<std::string, std::string> first;  // the first test of each reason for no verdict
  std::vector<Suspect> all;
  for (const Test& test : suite.tests) {
    std::set<std::string> estimators;
    for (const Sample& sample : test.samples) estimators.insert(sample.estimator);
    for (const std::string& name : estimators) ++claims[name];
    if (!is_failed(standing(test))) continue;
    const std::string how = to_string(standing(test));
    const std::string name =
        how == broken ? subject_of(test) : first.emplace(test.message, test.name).first->second;
    auto suspect = std::ranges::find_if(
        all, [&](const Suspect& each) { return each.name == name && each.standing == how; });
    if (suspect == all.end()) suspect = all.insert(suspect, {suite.name, name, how});
    suspect->tests.push_back(test.id);
    least[name] = std::min(least[name], deciding_channel(test).log10_p.value_or(0));
  }
  // A tie goes to the estimator whose claims are broken most often, then most clearly.
  std::ranges::sort(all, {}, [&](const Suspect& suspect) {
    return std::tuple(suspect.standing != broken, claims[suspect.name] == 0,
                      -std::ssize(suspect.tests), claims[suspect.name], least[suspect.name],
                      suspect.name);
  });
  for (Suspect& suspect : all) {
    const int of = suspect.standing == broken ? claims[suspect.name] : 0;
    if (of > 0)
      suspect.sentence =
          of_claims(static_cast<int>(suspect.tests.size()), of, "of its") + " broken";
  }
  return all;
}

RecordDisplay display(const Record& record) {
  RecordDisplay words{.verdict = run_sentence(record),
                      .counts = counts_text(standings(record)),
                      .rates = error_rates(record),
                      .seed = fmt::format("{}", record.seed)};
  for (const Suite& suite : record.suites) {
    for (Suspect& suspect : suspects(suite)) words.suspects.push_back(std::move(suspect));
  }
  // Broken suspects come first, then those that break the most tests.
  std::ranges::stable_sort(words.suspects, {}, [](const Suspect& suspect) {
    return std::pair(suspect.standing != to_string(Standing::broken),
                     -static_cast<std::ptrdiff_t>(suspect.tests.size()));
  });
  if (record.ledger.file.empty()) return words;
  words.ledger = ledger_title(record.ledger);
  words.quiet = quiet_sentence(record.ledger);
  words.notes = ledger_notes(record.ledger);
  for (const LedgerSeries& series : record.ledger.series) {
    words.series.push_back({.name = series_name(record.ledger, series),
                            .sentence = series_sentence(series),
                            .alarm = alarm_sentence(series),
                            .changes = changes(series)});
  }
  return words;
}

std::string trouble(const Test& test) {
  if (is_missed(test)) return "The planted bug was not caught. " + display(test).sentence;
  if (test.verdict == Verdict::fail && test.expected == Verdict::pass)
    return display(test).sentence;
  return test.verdict == Verdict::skipped ? test.message : without_advice(headline(test), test);
}

void tell_once(const Test& test, std::map<std::string, std::string>& first,
               const std::function<void(const Test&)>& tell) {
  if (test.verdict != Verdict::error) return tell(test);
  const std::string& id = first.emplace(test.message, test.id).first->second;
  if (id == test.id) return tell(test);
  Test again = test;
  again.message = fmt::format("the same error as `{}`", id);
  tell(again);
}

std::vector<Step> steps(const Test& test) {
  std::vector<Step> all;
  const auto add = [&](const char* label, std::string paste) {
    all.push_back({.label = label, .paste = std::move(paste)});
  };
  if (const auto& advice = test.advice; advice && advice->key.empty())
    all.push_back(
        {.label = test.verdict == Verdict::fail ? "note" : "to decide", .words = advice->words});
  else if (advice && test.file.empty())  // a claim of the command line
    add("to decide", with_option(test.replay, "--" + advice->key + " " + advice->value));
  else if (advice)
    add("write into the test", advice->key + ": " + advice->value);
  if (is_missed(test)) {
    std::string words = "leave `expect` out, if there is no bug";
    if (test.detect) {
      const bool relative = deciding_channel(test).effect.relative;
      words = fmt::format(
          "write `detect: {:.2g}{}`; if it passes again, any bug is smaller: leave `expect` out",
          relative ? 50 * *test.detect : *test.detect / 2, relative ? "%" : "");
    }
    all.push_back({.label = "to decide", .words = words});
  }
  if (!test.no_replay.empty()) all.push_back({.label = "again", .words = test.no_replay});
  if (test.replay.empty()) return all;
  add(test.verdict == Verdict::skipped ? "then" : "again", test.replay);
  if (test.image && test.verdict == Verdict::fail)
    add("see it", test.replay + " --report html=difference.html");
  return all;
}

Step explanation(const std::string& id) {
  return {.label = "more", .paste = "assay explain " + in_single_quotes(id)};
}

}  // namespace assay::reports
