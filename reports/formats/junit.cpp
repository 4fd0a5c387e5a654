#include <fmt/format.h>

#include <boost/algorithm/string.hpp>
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

std::string exact(const Number& value) { return value ? round_trip(*value) : ""; }

/// All digits, or what the logarithm tells of a p-value that underflowed.
std::string exact(const Number& p, const Number& log10_p) {
  if (!p && !log10_p) return "";
  const bool whole = p && (*p >= std::numeric_limits<double>::min() || std::isnan(*p));
  return whole ? round_trip(*p) : p_text(p, log10_p);
}

/// Names and values; what has no value is left out.
using Properties = std::vector<std::pair<std::string, std::string>>;

std::string properties(const char* indent, const Properties& all) {
  std::string out = fmt::format("{}<properties>\n", indent);
  for (const auto& [name, value] : all) {
    if (!value.empty())
      out += fmt::format("{} <property{}{}/>\n", indent, attribute("name", name),
                         attribute("value", value));
  }
  return out + fmt::format("{}</properties>\n", indent);
}

std::string test_properties(const Test& test) {
  const Channel channel = worst_channel(test);
  const Effect& effect = channel.effect;
  Properties all{{"id", test.id},
                 {"claim", test.claim},
                 {"verdict", to_string(test.verdict)},
                 {"expected", to_string(test.expected)},
                 {"outcome", verdict_text(test)},
                 {"method", test.method},
                 {"channel", channel.name},
                 {"quantity", effect.quantity},
                 {"estimate", exact(effect.estimate)},
                 {"low", exact(effect.low)},
                 {"high", exact(effect.high)},
                 {"confidence", range_text(effect).empty() ? "" : exact(effect.confidence)},
                 {"statistic", exact(channel.statistic)},
                 {"p_value", exact(channel.p_value, channel.log10_p)},
                 {"log10_p", exact(channel.log10_p)},
                 {"p_adjusted", exact(channel.p_adjusted, channel.log10_p_adjusted)},
                 {"p_pass", exact(channel.p_pass, channel.log10_p_pass)},
                 {"alpha", exact(test.alpha)},
                 {"detect", exact(test.detect)},
                 {"detectable", exact(test.detectable)}};
  if (is_told_by_place(test)) {
    const Effect at_place = effect_in_sentence(test);
    all.emplace_back("place", test.image->winner.place);
    all.emplace_back("place.estimate", exact(at_place.estimate));
    all.emplace_back("place.low", exact(at_place.low));
    all.emplace_back("place.high", exact(at_place.high));
  }
  const std::vector<const Sample*> samples = worst_samples(test);
  for (std::size_t i = 0; i < samples.size() && i < 2; ++i) {
    const Sample& sample = *samples[i];
    all.emplace_back("mean." + sample.estimator, exact(sample.mean));
    all.emplace_back("variance." + sample.estimator, exact(sample.variance));
    all.emplace_back("primaries." + sample.estimator, std::to_string(sample.primaries));
    all.emplace_back("secondaries." + sample.estimator, std::to_string(sample.secondaries));
  }
  all.emplace_back("rays", std::to_string(rays(total_cost(test))));
  all.emplace_back("replay", test.replay);
  return properties("   ", all);
}

std::string element(const char* name, const std::string& attributes, const std::string& text) {
  return fmt::format("   <{}{}>{}</{}>\n", name, attributes, escape_xml(cap(text, text_limit)),
                     name);
}

std::string outcome_element(const Test& test) {
  const std::string message = attribute("message", headline(test));
  const std::string type = attribute("type", to_string(test.verdict));
  const Standing how = standing(test);
  if (how == Standing::holds || how == Standing::caught) return {};
  if (!is_failed(how)) return element("skipped", message, {});
  return element(test.verdict == Verdict::error ? "error" : "failure", message + type,
                 plain_text(test));
}

// GitLab and Jenkins know a case by its class name and name, and drop a second one silently.
class UniqueNames {
 public:
  std::string attributes(const std::string& group, const std::string& name) {
    std::pair unique{tidy(group, "suite"), tidy(name, "test")};
    const std::string first = unique.second;
    for (int copy = 2; !taken_.insert(unique).second; ++copy)
      unique.second = fmt::format("{} ({})", first, copy);
    return attribute("classname", unique.first) + attribute("name", unique.second);
  }

 private:
  static std::string tidy(const std::string& text, const char* otherwise) {
    const std::string line = boost::trim_copy_if(one_line(text), boost::is_any_of(" "));
    return line.empty() ? otherwise : cap(line, attribute_limit / 2);
  }

  std::set<std::pair<std::string, std::string>> taken_;
};

std::string test_case(const Suite& suite, const Test& test, UniqueNames& names) {
  const std::size_t slash = test.id.find('/');
  std::string out = "  <testcase";
  out += slash == std::string::npos
             ? names.attributes(suite.name, test.name)
             : names.attributes(test.id.substr(0, slash), test.id.substr(slash + 1));
  if (!test.file.empty()) out += attribute("file", test.file);
  if (test.line > 0) out += fmt::format(" line=\"{}\"", test.line);
  out += time_attribute(total_cost(test).seconds) + ">\n";
  return out + test_properties(test) + outcome_element(test) +
         element("system-out", "", plain_text(test)) + "  </testcase>\n";
}

struct Counts {
  int tests = 0, failures = 0, errors = 0, skipped = 0;
  double seconds = 0;

  void add(const Test& test) {
    const Standing how = standing(test);
    const bool error = is_failed(how) && test.verdict == Verdict::error;
    ++tests;
    errors += error;
    failures += is_failed(how) && !error;
    skipped += how == Standing::undecided || how == Standing::not_run;
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

std::string test_suite(const Record& record, const Suite& suite, UniqueNames& names) {
  Counts counts;
  for (const Test& test : suite.tests) counts.add(test);
  std::string out =
      suite_opening(record, suite.name.empty() ? "suite" : suite.name, suite.file, counts);
  out += properties("  ", {{"seed", std::to_string(suite.seed)},
                           {"alpha", exact(suite.alpha)},
                           {"beta", exact(suite.beta)},
                           {"tool", record.tool.name},
                           {"version", record.tool.version},
                           {"commit", record.tool.commit},
                           {"isa", record.environment.isa},
                           {"threads", std::to_string(record.environment.threads)}});
  for (const Test& test : suite.tests) out += test_case(suite, test, names);
  return out + " </testsuite>\n";
}

std::string series_case(const Ledger& ledger, const LedgerSeries& series, UniqueNames& names) {
  std::string out = "  <testcase" + names.attributes("ledger", series_name(ledger, series)) +
                    time_attribute(0) + ">\n";
  out += properties("   ", {{"series", series.series},
                            {"nights", std::to_string(series.nights.size())},
                            {"estimate", exact(series.estimate)},
                            {"standard_error", exact(series.standard_error)},
                            {"log_e", exact(series.log_e())},
                            {"limit", exact(series.limit)},
                            {"since", series.since},
                            {"moved", series.moved}});
  const std::string alarm = alarm_sentence(series);
  const std::string text =
      series_sentence(series) + "\n" + (series.alarm ? alarm + "\n" : "") + series.note;
  if (series.alarm)
    out += element("failure", attribute("message", alarm) + attribute("type", "alarm"), text);
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
