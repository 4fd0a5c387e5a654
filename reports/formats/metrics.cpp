#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::size_t label_limit = 1024;

using Labels = std::vector<std::pair<const char*, std::string>>;

/// A label's value.
std::string quoted(const std::string& text) {
  constexpr Form forms[] = {{'\\', "\\\\"}, {'"', "\\\""}, {'\n', "\\n"}};
  return "\"" + escape(cap(clean(text), label_limit), forms) + "\"";
}

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{:.6g}", value);
}

/// A metric and its samples. Names and labels identify one: what repeats is counted.
class Family {
 public:
  Family(const char* name, const char* help) : name_(name), help_(help) {}

  void add(Labels labels, Number value) {
    if (!value) return;
    std::string text = written(labels);
    for (int again = 2; !seen_.insert(text).second; ++again) {
      Labels counted = labels;
      counted.emplace_back("again", std::to_string(again));
      text = written(counted);
    }
    samples_ += fmt::format("{}{{{}}} {}\n", name_, text, number(*value));
  }

  std::string text() const {
    if (samples_.empty()) return "";
    return fmt::format("# HELP {} {}\n# TYPE {} gauge\n{}", name_, help_, name_, samples_);
  }

 private:
  static std::string written(const Labels& labels) {
    std::vector<std::string> all;
    for (const auto& [name, value] : labels)
      all.push_back(fmt::format("{}={}", name, quoted(value)));
    return fmt::format("{}", fmt::join(all, ","));
  }

  const char* name_;
  const char* help_;
  std::string samples_;
  std::set<std::string> seen_;
};

std::string of_tests(const Record& record) {
  Family ok("assay_ok", "Whether the test came out as expected.");
  Family effect("assay_effect", "Estimate of what the claim is about.");
  Family lower("assay_effect_lower", "Lower end of the effect's interval.");
  Family upper("assay_effect_upper", "Upper end of the effect's interval.");
  Family detectable("assay_detectable", "The least effect that would have been found.");
  for (const Test* each : tests_of(record)) {
    const Test& test = *each;
    if (test.verdict == Verdict::skipped) continue;
    ok.add({{"test", test.id}, {"verdict", to_string(test.verdict)}}, test.ok ? 1 : 0);
    detectable.add({{"test", test.id}}, test.detectable);
    const auto add = [&](const std::string& where, const Effect& found) {
      const Labels labels{{"test", test.id}, {"channel", where}, {"quantity", found.quantity}};
      effect.add(labels, found.estimate);
      lower.add(labels, found.low);
      upper.add(labels, found.high);
    };
    for (const Channel& channel : test.channels) add(channel.name, channel.effect);
    if (is_told_by_place(test)) add("place", effect_in_sentence(test));
  }
  return ok.text() + effect.text() + lower.text() + upper.text() + detectable.text();
}

std::string of_estimators(const Record& record) {
  Family mean("assay_mean", "Mean of the estimator.");
  Family variance("assay_variance", "Variance of the estimator, of a primary where it averages.");
  for (const Suite& suite : record.suites) {
    for (const EstimatorSummary& estimator : suite.estimators) {
      for (const EstimatorChannel& channel : estimator.channels) {
        const Labels labels{
            {"suite", suite.name}, {"estimator", estimator.name}, {"channel", channel.name}};
        mean.add(labels, channel.mean.value);
        variance.add(labels, channel.variance.value);
      }
    }
  }
  return mean.text() + variance.text();
}

}  // namespace

std::string metrics(const Record& record) {
  return of_tests(record) + of_estimators(record) + "# EOF\n";
}

}  // namespace assay::reports
