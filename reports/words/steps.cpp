#include "reports/words/steps.h"

#include <fmt/format.h>

#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/evidence.h"

namespace assay::reports {

std::string trouble(const Test& test) {
  const bool missed = test.expected == Verdict::fail && test.verdict == Verdict::pass;
  if (missed) return "The planted bug was not caught. " + display(test).sentence;
  if (test.verdict == Verdict::fail && test.expected == Verdict::pass)
    return display(test).sentence;
  return test.verdict == Verdict::skipped ? test.message : headline(test);
}

namespace {

/// The text that a message asks to write; "" if it asks for nothing.
std::string asked_for(const std::string& message) {
  constexpr std::string_view lead = "write `";
  const std::size_t at = message.rfind(lead);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + lead.size();
  return message.substr(begin, message.find('`', begin) - begin);
}

}  // namespace

std::vector<Step> steps(const Test& test) {
  std::vector<Step> all;
  if (const std::string text = asked_for(test.message); !text.empty()) {
    all.push_back({text.starts_with("--") ? "give the command" : "write into the test", text});
  }
  const bool missed = test.expected == Verdict::fail && test.verdict == Verdict::pass;
  const Effect effect = deciding_channel(test).effect;
  if (missed && test.detect && effect.relative)
    all.push_back({"write into the test", fmt::format("detect: {:.2g}%", 50 * *test.detect)});
  if (test.replay.empty()) return all;
  if (test.verdict != Verdict::skipped) all.push_back({"again", test.replay});
  if (test.verdict == Verdict::skipped) all.push_back({"then", test.replay});
  if (test.image && test.verdict == Verdict::fail)
    all.push_back({"see it", test.replay + " --report html=difference.html"});
  return all;
}

Step explanation(const Test& test) {
  std::string quoted = "'";
  for (const char c : test.id) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return {"more", "assay explain " + quoted + "'"};
}

}  // namespace assay::reports
