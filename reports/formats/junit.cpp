#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "reports/report_formats.h"
#include "reports/words/describe.h"
#include "reports/words/display.h"
#include "reports/words/ledger.h"
#include "reports/words/number.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

// A case has up to two texts; servers cut or refuse much longer ones.
constexpr std::size_t text_limit = 32 * 1024 - 1;
constexpr std::size_t attribute_limit = 1024;

std::string attribute(const std::string& name, const std::string& value) {
  return fmt::format(" {}=\"{}\"", name, escape_attribute(cap(clean(value), attribute_limit)));
}

// Servers read times with a plain decimal point and no exponent.
std::string time_attribute(double seconds) { return fmt::format(" time=\"{:.6f}\"", seconds); }

std::string property(const std::string& name, const std::string& value) {
  return fmt::format("    <property{}{}/>\n", attribute("name", name), attribute("value", value));
}

void add(std::string& out, const std::string& name, const Number& value) {
  if (value) out += property(name, round_trip(*value));
}

// All digits, or what the logarithm tells of a p-value that underflowed.
void add_p(std::string& out, const std::string& name, const NamedP& p) {
  if (!p.exists()) return;
  const bool whole = p.p && (*p.p >= std::numeric_limits<double>::min() || std::isnan(*p.p));
  out += property(name, whole ? round_trip(*p.p) : p_text(p.p, p.log10_p));
}

void add(std::string& out, const std::string& name, const std::string& value) {
  if (!value.empty()) out += property(name, value);
}

std::string sample_properties(const Test& test) {
  std::string out;
  const std::vector<const Sample*> samples = worst_samples(test);
  for (std::size_t i = 0; i < samples.size() && i < 2; ++i) {
    const Sample& sample = *samples[i];
    const auto key = [&sample](const char* name) {
      return fmt::format("{}.{}", name, sample.estimator);
    };
    add(out, key("mean"), sample.mean);
    add(out, key("variance"), sample.variance);
    out += property(key("primaries"), fmt::format("{}", sample.primaries));
    out += property(key("secondaries"), fmt::format("{}", sample.secondaries));
  }
  return out;
}

std::string test_properties(const Test& test) {
  const Channel channel = worst_channel(test);
  std::string out;
  add(out, "id", test.id);
  add(out, "claim", test.claim);
  add(out, "verdict", std::string(to_string(test.verdict)));
  add(out, "expected", std::string(to_string(test.expected)));
  add(out, "outcome", verdict_text(test));
  add(out, "method", test.method);
  add(out, "channel", channel.name);
  add(out, "quantity", channel.effect.quantity);
  add(out, "estimate", channel.effect.estimate);
  add(out, "low", channel.effect.low);
  add(out, "high", channel.effect.high);
  if (!interval_name(channel.effect).empty())
    add(out, "confidence", Number(channel.effect.confidence));
  add(out, "statistic", channel.statistic);
  add_p(out, "p_value", {"", channel.p_value, channel.log10_p});
  add(out, "log10_p", channel.log10_p);
  add_p(out, "p_adjusted", {"", channel.p_adjusted, channel.log10_p_adjusted});
  add_p(out, "p_pass", {"", channel.p_pass, channel.log10_p_pass});
  add(out, "alpha", test.alpha);
  add(out, "detect", test.detect);
  add(out, "detectable", test.detectable);
  out += sample_properties(test);
  out += property("rays", fmt::format("{}", rays(total_cost(test))));
  add(out, "replay", test.replay);
  return "   <properties>\n" + out + "   </properties>\n";
}

std::string element(const char* name, const std::string& attributes, const std::string& text) {
  return fmt::format("   <{}{}>{}</{}>\n", name, attributes, escape_xml(cap(text, text_limit)),
                     name);
}

std::string outcome_element(const Test& test) {
  const std::string message = attribute("message", headline(test));
  const std::string type = attribute("type", to_string(test.verdict));
  const Outcome result = outcome(test);
  if (result == Outcome::passed) return {};
  if (result != Outcome::failed) return element("skipped", message, {});
  return element(test.verdict == Verdict::error ? "error" : "failure", message + type,
                 plain_text(test));
}

// GitLab and Jenkins know a case by its class name and name, and drop a second one silently.
class UniqueNames {
 public:
  std::pair<std::string, std::string> of(const Suite& suite, const Test& test) {
    const std::size_t slash = test.id.find('/');
    const std::string group = slash == std::string::npos ? suite.name : test.id.substr(0, slash);
    return of(group, slash == std::string::npos ? test.name : test.id.substr(slash + 1));
  }

  std::pair<std::string, std::string> of(std::string group, std::string name) {
    group = tidy(group, "suite");
    name = tidy(name, "test");
    std::string unique = name;
    for (int copy = 2; !taken_.emplace(group, unique).second; ++copy)
      unique = fmt::format("{} ({})", name, copy);
    return {group, unique};
  }

 private:
  static std::string tidy(const std::string& text, const char* otherwise) {
    const std::string line = one_line(text);
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos) return otherwise;
    return cap(line.substr(first, line.find_last_not_of(' ') - first + 1), attribute_limit / 2);
  }

  std::set<std::pair<std::string, std::string>> taken_;
};

std::string case_opening(const std::pair<std::string, std::string>& name) {
  return "  <testcase" + attribute("classname", name.first) + attribute("name", name.second);
}

std::string test_case(const Suite& suite, const Test& test, UniqueNames& names) {
  std::string out = case_opening(names.of(suite, test));
  if (!test.file.empty()) out += attribute("file", test.file);
  if (test.line > 0) out += fmt::format(" line=\"{}\"", test.line);
  out += time_attribute(total_cost(test).seconds) + ">\n";
  out += test_properties(test);
  out += outcome_element(test);
  out += element("system-out", "", plain_text(test));
  return out + "  </testcase>\n";
}

struct Counts {
  int tests = 0, failures = 0, errors = 0, skipped = 0;
  double seconds = 0;

  void add(const Test& test) {
    const Outcome result = outcome(test);
    const bool error = result == Outcome::failed && test.verdict == Verdict::error;
    ++tests;
    errors += error;
    failures += result == Outcome::failed && !error;
    skipped += result == Outcome::inconclusive || result == Outcome::skipped;
    seconds += total_cost(test).seconds;
  }
  std::string attributes() const {
    return fmt::format(" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", tests,
                       failures, errors, skipped) +
           time_attribute(seconds);
  }
};

/// A series is a case of its own: servers know no other way to say that something is wrong.
Counts ledger_counts(const Ledger& ledger) {
  if (ledger.file.empty()) return {};
  return {.tests = static_cast<int>(ledger.series.size()), .failures = alarms(ledger)};
}

std::string suite_opening(const Record& record, const std::string& name, const std::string& file,
                          const Counts& counts) {
  std::string out = " <testsuite" + attribute("name", name);
  if (!file.empty()) out += attribute("file", file);
  out += counts.attributes();
  if (!record.started.empty()) out += attribute("timestamp", record.started);
  return out + ">\n";
}

std::string suite_properties(const Record& record, const Suite& suite) {
  std::string out;
  add(out, "seed", fmt::format("{}", suite.seed));
  add(out, "alpha", Number(suite.alpha));
  add(out, "beta", Number(suite.beta));
  add(out, "tool", record.tool.name);
  add(out, "version", record.tool.version);
  add(out, "commit", record.tool.commit);
  add(out, "isa", record.environment.isa);
  add(out, "threads", fmt::format("{}", record.environment.threads));
  return "  <properties>\n" + out + "  </properties>\n";
}

std::string test_suite(const Record& record, const Suite& suite, UniqueNames& names) {
  Counts counts;
  for (const Test& test : suite.tests) counts.add(test);
  std::string out =
      suite_opening(record, suite.name.empty() ? "suite" : suite.name, suite.file, counts) +
      suite_properties(record, suite);
  for (const Test& test : suite.tests) out += test_case(suite, test, names);
  return out + " </testsuite>\n";
}

std::string series_case(const Ledger& ledger, const LedgerSeries& series, UniqueNames& names) {
  std::string out = case_opening(names.of("ledger", series_name(ledger, series))) +
                    time_attribute(0) + ">\n   <properties>\n";
  add(out, "series", series.series);
  add(out, "nights", fmt::format("{}", series.nights.size()));
  add(out, "estimate", series.estimate);
  add(out, "standard_error", series.standard_error);
  add(out, "log_e", series.log_e());
  add(out, "limit", series.limit);
  add(out, "since", series.since);
  add(out, "moved", series.moved);
  out += "   </properties>\n";
  const std::string text = series_sentence(series) + "\n" +
                           (series.alarm ? alarm_sentence(series) + "\n" : "") + series.note;
  if (series.alarm) {
    out += element("failure",
                   attribute("message", alarm_sentence(series)) + attribute("type", "alarm"), text);
  }
  return out + element("system-out", "", text) + "  </testcase>\n";
}

std::string ledger_suite(const Record& record, UniqueNames& names) {
  const Ledger& ledger = record.ledger;
  if (ledger.file.empty()) return {};
  std::string out = suite_opening(record, ledger_title(ledger), "", ledger_counts(ledger));
  for (const LedgerSeries& series : ledger.series) out += series_case(ledger, series, names);
  return out + " </testsuite>\n";
}

}  // namespace

std::string junit(const Record& record) {
  Counts counts;
  for (const Test* test : tests_of(record)) counts.add(*test);
  const Counts nights = ledger_counts(record.ledger);
  counts.tests += nights.tests;
  counts.failures += nights.failures;
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" +
                    attribute("name", record.tool.name.empty() ? "assay" : record.tool.name) +
                    counts.attributes() + ">\n";
  UniqueNames names;
  for (const Suite& suite : record.suites) out += test_suite(record, suite, names);
  return out + ledger_suite(record, names) + "</testsuites>\n";
}

}  // namespace assay::reports
