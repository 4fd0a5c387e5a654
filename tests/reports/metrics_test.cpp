#include <charconv>

#include "reports/report_formats.h"
#include "tests/reports/prelude.h"

namespace assay::reports {
namespace {

/// The mistake in a text of OpenMetrics 1.0 that has gauges alone, or "". Its grammar: families of
/// HELP and TYPE, then samples `name{label="escaped",…} number`, each once, and a last `# EOF`.
std::string wrong_with(const std::string& text) {
  static const std::regex sample(
      R"re(([a-zA-Z_:][\w:]*)(\{\w+="([^"\\]|\\["\\n])*"(,\w+="([^"\\]|\\["\\n])*")*\})? (\S+))re");
  static const std::regex label(R"re((\w+)="(?:[^"\\]|\\.)*")re");
  std::set<std::string> families, samples;
  std::string family;
  std::vector<std::string> all = lines(text);
  if (!text.ends_with("\n") || all.back() != "# EOF") return "no # EOF";
  all.pop_back();
  for (const std::string& line : all) {
    std::smatch parts;
    if (line.starts_with("# HELP ")) {
      family = line.substr(7, line.find(' ', 7) - 7);
      if (!families.insert(family).second) return "a second family: " + line;
    } else if (line.starts_with("#")) {
      if (line != "# TYPE " + family + " gauge") return "no type of its family: " + line;
    } else if (!std::regex_match(line, parts, sample) || parts[1] != family) {
      return "no sample of its family: " + line;
    } else {
      const std::string labels = parts[2], number = parts[6];
      std::multiset<std::string> names;
      for (std::sregex_iterator at(labels.begin(), labels.end(), label);
           at != std::sregex_iterator(); ++at)
        names.insert((*at)[1]);
      if (std::ranges::adjacent_find(names) != names.end()) return "a label twice: " + line;
      if (!samples.insert(family + labels).second) return "a sample twice: " + line;
      double value = 0;
      const auto [end, error] =
          std::from_chars(number.data(), number.data() + number.size(), value);
      const bool is_number = error == std::errc() && end == number.data() + number.size();
      if (!is_number && number != "NaN" && number != "+Inf" && number != "-Inf")
        return "no number: " + line;
    }
  }
  return "";
}

TEST(Metrics, OfTheExampleAreOpenMetrics) { EXPECT_EQ(wrong_with(metrics(example_record())), ""); }

TEST(Metrics, AreRoundedSoThatTheyCompareEqual) {
  Record record = record_of({});
  record.suites[0].estimators.resize(1);
  record.suites[0].estimators[0].channels.resize(1);
  const auto with_mean = [&](double mean) {
    record.suites[0].estimators[0].channels[0].mean.value = mean;
    return metrics(record);
  };
  EXPECT_EQ(with_mean(0.1), with_mean(0.1 + 1e-12));
  EXPECT_NE(with_mean(0.1), with_mean(0.1001));
}

TEST(Metrics, OfNothingIsAnEnd) { EXPECT_EQ(metrics({}), "# EOF\n"); }

TEST(Metrics, TheReaderSeesWhatIsWrong) {
  const std::string head = "# HELP a b\n# TYPE a gauge\n";
  EXPECT_EQ(wrong_with(head + "a{x=\"\\\\\"} 1\n# EOF\n"), "");
  for (const char* wrong : {"a{x=\"1\"} 1\n", "a{x=\"1\" 1\n# EOF\n", "a 1,5\n# EOF\n",
                            "b 1\n# EOF\n", "a{x=\"\\q\"} 1\n# EOF\n", "a 1\na 2\n# EOF\n",
                            "a{x=\"1\",x=\"2\"} 1\n# EOF\n", "# EOF\na 1\n# EOF\n"}) {
    EXPECT_NE(wrong_with(head + wrong), "") << wrong;
  }
}

RC_GTEST_PROP(Metrics, OfAnyRecordAreOpenMetrics, ()) {
  RC_ASSERT(wrong_with(metrics(random_record())) == "");
}

}  // namespace
}  // namespace assay::reports
