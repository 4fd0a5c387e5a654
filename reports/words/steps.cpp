#include "reports/words/steps.h"

#include <fmt/format.h>

#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/summary.h"

namespace assay::reports {

std::string trouble(const Test& test) {
  const bool missed = test.expected == Verdict::fail && test.verdict == Verdict::pass;
  if (missed) return "The planted bug was not caught. " + display(test).sentence;
  if (test.verdict == Verdict::fail && test.expected == Verdict::pass)
    return display(test).sentence;
  return test.verdict == Verdict::skipped ? test.message : headline(test);
}

std::vector<Step> steps(const Test& test) {
  std::vector<Step> all;
  if (!test.replay.empty() && test.verdict != Verdict::skipped) {
    all.push_back({"again", test.replay});
  }
  return all;
}

Step explanation(const Test& test) {
  std::string quoted = "'";
  for (const char c : test.id) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return {"more", "assay explain " + quoted + "'"};
}

}  // namespace assay::reports
