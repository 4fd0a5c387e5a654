#pragma once

// These words all reports share, and the steps to take about a claim that is not as it should be.
// The JSON record holds them as `display`.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/record/record.h"
#include "reports/words/describe.h"
#include "reports/words/kill_matrix.h"

namespace assay::reports {

/// "False alarms: at most 4 runs in 100." of a total alpha; empty if that is 0.
std::string false_alarms(double alpha);

/// The same of all suites with tests.
std::string false_alarms(const Record&);

/// The same, and how often a claim passes that is wrong by `detect`.
std::string error_rates(const Record&);

/// "broken", "no verdict", "undecided", "holds", "caught", "not run".
const char* to_string(Standing);

/// How many claims stand how.
using Standings = std::map<Standing, int>;
Standings standings(const Suite&);
Standings standings(const Record&);

/// The same as a sentence for a title.
std::string tally_sentence(Standings);

/// A run's tally, after the alarms of its ledger: "1 ledger alarm over all nights. In this run: …".
std::string run_sentence(const Record&);

/// "72 hold, 2 planted bugs caught"; where not all is well "1 broken, 2 undecided, 14 ok".
std::string counts_text(Standings);

/// Something to do, in words or as a line to paste.
struct Step {
  std::string label;  ///< "again", "write into the test"
  std::string words;
  std::string paste;
  ASSAY_FIELDS(Step, label, words, paste)
};
/// The most useful first. Empty if the words of trouble() are all there is to say.
std::vector<Step> steps(const Test&);

/// The meaning of a verdict: "Nothing speaks against the claim."; empty where a bug was missed.
std::string meaning(const Test&);

struct TestDisplay {
  std::string standing;
  std::string verdict;   ///< "pass", "fail (as expected)"
  std::string sentence;  ///< what was found, without a p-value; why there is no verdict
  std::string meaning;
  std::string effect;    ///< Such as "+1.07 %". Empty if there is none.
  std::string interval;  ///< Such as "+0.06 % to +2.1 %".
  std::string margin;    ///< The effect that must be caught, as "0.5 %".
  std::string chance;    ///< The chance of such data if nothing is wrong, as "1 in 17,000".
  std::string place;
  std::vector<Step> steps;
  std::vector<Fact> facts;
  ASSAY_FIELDS(TestDisplay, standing, verdict, sentence, meaning, effect, interval, margin, chance,
               place, steps, facts)
};
TestDisplay display(const Test&);

struct StatementDisplay {
  std::string answer;
  std::string holds;
  std::string fails;
  ASSAY_FIELDS(StatementDisplay, answer, holds, fails)
};
struct SuiteDisplay {
  std::string counts;
  std::string levels;
  std::optional<KillMatrix> kills;  ///< none: not worth showing
  std::vector<StatementDisplay> statements;
  ASSAY_FIELDS(SuiteDisplay, counts, levels, kills, statements)
};
SuiteDisplay display(const Suite&);

/// The estimator on the left side of broken claims, with these claims. A claim whose left side has
/// no sample is a suspect alone. Claims without a verdict share one by their reason.
struct Suspect {
  std::string suite;
  std::string name;
  std::string standing;            ///< of its claims
  std::vector<std::string> tests;  ///< ids of its broken claims
  std::string sentence;            ///< "4 of its 17 claims broken"
  ASSAY_FIELDS(Suspect, suite, name, standing, tests, sentence)
};
/// Each broken claim, and each without a verdict, has one.
std::vector<Suspect> suspects(const Suite&);

struct SeriesDisplay {
  std::string name;
  std::string sentence;
  std::string alarm;    ///< empty without one
  std::string changes;  ///< command that lists the commits of the night it moved
  ASSAY_FIELDS(SeriesDisplay, name, sentence, alarm, changes)
};
struct RecordDisplay {
  std::string verdict;  ///< "5 of 126 claims broken"
  std::string counts;
  std::string rates;
  std::string seed;  ///< all digits
  std::vector<Suspect> suspects;
  std::string ledger;
  std::string quiet;
  std::vector<std::string> notes;
  std::vector<SeriesDisplay> series;
  ASSAY_FIELDS(RecordDisplay, verdict, counts, rates, seed, suspects, ledger, quiet, notes, series)
};
RecordDisplay display(const Record&);

/// The trouble with a claim, without a p-value where it can be said so, and without its advice.
std::string trouble(const Test&);

/// Tells the test. An error that an earlier test had gives that test's name. `first` has ids by
/// message.
void tell_once(const Test& test, std::map<std::string, std::string>& first,
               const std::function<void(const Test&)>& tell);

/// The command that tells more of a test.
Step explanation(const std::string& id);

}  // namespace assay::reports
