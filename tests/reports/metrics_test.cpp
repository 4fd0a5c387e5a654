#include "reports/formats/metrics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <charconv>

#include "example_record.h"
#include "random_record.h"
#include "tests/prelude.h"

namespace assay::reports {
namespace {

/// Reads OpenMetrics 1.0 as far as gauges need it. Its grammar: families of HELP and TYPE, then
/// samples `name{label="escaped",…} number`, each once, and a last line `# EOF`. Returns the
/// mistake in a text, or "".
class Reader {
 public:
  std::string wrong_with(const std::string& text) {
    std::istringstream stream(text);
    std::string line;
    bool ended = false;
    while (std::getline(stream, line)) {
      if (ended) return "a line after # EOF";
      if (line == "# EOF") {
        ended = true;
      } else if (const std::string wrong = line_wrong(line); !wrong.empty()) {
        return wrong + ": " + line;
      }
    }
    if (!ended || text.back() != '\n') return "no # EOF";
    return "";
  }

 private:
  static std::string take_name(std::string_view& rest) {
    std::size_t size = 0;
    while (size < rest.size() && (std::isalnum(static_cast<unsigned char>(rest[size])) ||
                                  rest[size] == '_' || rest[size] == ':')) {
      ++size;
    }
    const std::string name(rest.substr(0, size));
    rest.remove_prefix(size);
    return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "" : name;
  }

  static bool take(std::string_view& rest, std::string_view what) {
    if (!rest.starts_with(what)) return false;
    rest.remove_prefix(what.size());
    return true;
  }

  static bool take_value(std::string_view& rest) {
    if (!take(rest, "\"")) return false;
    while (!rest.empty() && rest[0] != '"') {
      if (rest[0] == '\\' && rest.find_first_of("\\\"n", 1) != 1) return false;
      rest.remove_prefix(rest[0] == '\\' ? 2 : 1);
    }
    return take(rest, "\"");
  }

  std::string line_wrong(std::string_view line) {
    if (take(line, "# HELP ")) {
      const std::string name = take_name(line);
      if (!families_.insert(name).second) return "a second family";
      family_ = name;
      return line.starts_with(" ") ? "" : "no help";
    }
    if (take(line, "# TYPE ")) {
      return take_name(line) == family_ && line == " gauge" ? "" : "no type of its family";
    }
    if (take_name(line) != family_) return "a sample of another family";
    const std::string_view labels = line;
    if (take(line, "{")) {
      std::set<std::string> names;
      do {
        if (!names.insert(take_name(line)).second) return "a label twice";
        if (!take(line, "=") || !take_value(line)) return "no label";
      } while (take(line, ","));
      if (!take(line, "}")) return "no end of labels";
    }
    const std::string key = family_ + std::string(labels.substr(0, labels.size() - line.size()));
    if (!samples_.insert(key).second) return "a sample twice";
    if (!take(line, " ")) return "no value";
    if (line == "NaN" || line == "+Inf" || line == "-Inf") return "";
    double value = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    return error == std::errc() && end == line.data() + line.size() ? "" : "no number";
  }

  std::string family_;
  std::set<std::string> families_;
  std::set<std::string> samples_;
};

TEST(Metrics, OfTheExampleAreOpenMetrics) {
  const std::string text = metrics(example_record());
  EXPECT_EQ(Reader().wrong_with(text), "");
  EXPECT_THAT(text, HasSubstr("\nassay_mean{suite=\"triangle luminaire\",estimator=\"area\","
                              "channel=\"value\"} 0.4812\n"));
  EXPECT_THAT(text, HasSubstr("\nassay_ok{test=\"triangle/mean(area) == analytic\","));
}

TEST(Metrics, AreRoundedSoThatTheyCompareEqual) {
  Record one, other;
  for (Record* record : {&one, &other}) {
    record->suites.resize(1);
    record->suites[0].estimators.resize(1);
    record->suites[0].estimators[0].channels.resize(1);
  }
  one.suites[0].estimators[0].channels[0].mean.value = 0.1;
  other.suites[0].estimators[0].channels[0].mean.value = 0.1 + 1e-12;
  EXPECT_EQ(metrics(one), metrics(other));
  other.suites[0].estimators[0].channels[0].mean.value = 0.1001;
  EXPECT_NE(metrics(one), metrics(other));
}

TEST(Metrics, OfNothingIsAnEnd) { EXPECT_EQ(metrics({}), "# EOF\n"); }

TEST(Metrics, TheReaderSeesWhatIsWrong) {
  const std::string head = "# HELP a b\n# TYPE a gauge\n";
  EXPECT_EQ(Reader().wrong_with(head + "a{x=\"\\\\\"} 1\n# EOF\n"), "");
  for (const char* wrong : {"a{x=\"1\"} 1\n", "a{x=\"1\" 1\n# EOF\n", "a 1,5\n# EOF\n",
                            "b 1\n# EOF\n", "a{x=\"\\q\"} 1\n# EOF\n", "a 1\na 2\n# EOF\n",
                            "a{x=\"1\",x=\"2\"} 1\n# EOF\n", "# EOF\na 1\n"}) {
    EXPECT_NE(Reader().wrong_with(head + wrong), "") << wrong;
  }
}

RC_GTEST_PROP(Metrics, OfAnyRecordAreOpenMetrics, ()) {
  RC_ASSERT(Reader().wrong_with(metrics(random_record())) == "");
}

}  // namespace
}  // namespace assay::reports
