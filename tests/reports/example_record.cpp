#include "tests/reports/example_record.h"

#include <fstream>
#include <sstream>

#include "reports/report_formats.h"

namespace assay::reports {
namespace {

Record approved() {
  const std::string file = ASSAY_SOURCE_DIR "/tests/golden/record.json";
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  Record record = read_json(text.str(), file);
  // Writers repair these texts, so that the file has them repaired.
  Suite& hostile = record.suites.at(1);
  hostile.about =
      "Text with \x1b[31mescapes\x1b[0m, a bell \x07, half a character \xC3, "
      "a wide 光線追跡 and a right-to-left override \xE2\x80\xAE.\nA second line.";
  for (std::size_t i = 0; i < 2; ++i) {
    hostile.tests.at(i).message =
        "]]> </failure> <script>alert(1)</script>\nsecond line\r\nthird \x01 line";
  }
  hostile.statements.at(0).text = "Text | with *marks*, <b>tags</b> and a \x1b[31mescape.";
  return record;
}

const Record& example() {
  static const Record record = approved();
  return record;
}

const Test& test_at(std::size_t index) { return example().suites.at(0).tests.at(index); }

}  // namespace

Record example_record() { return example(); }

Test passing() { return test_at(0); }
Test failing() { return test_at(2); }
Test caught_mutant() { return test_at(3); }
Test surviving_mutant() { return test_at(4); }
Test undecided() { return test_at(5); }
Test not_run() { return test_at(8); }

Test judged(Verdict verdict, Verdict expected) {
  Test test;
  test.id = "suite/name";
  test.verdict = verdict;
  test.expected = expected;
  test.ok = verdict == expected;
  return test;
}

Record record_of(const std::vector<Test>& tests) {
  Record record;
  record.suites.push_back({.name = "suite", .tests = tests});
  return record;
}

Test base(const std::string& claim) {
  Test test = passing();
  test.name = test.claim = claim;
  test.id = "triangle/" + claim;
  test.samples.clear();
  test.channels.clear();
  return test;
}

Sample sample(const std::string& estimator) {
  Sample made = passing().samples.at(0);
  made.estimator = estimator;
  made.plugin = "luminaire/" + estimator;
  return made;
}

Channel channel(const Effect& effect) {
  Channel made = passing().channels.at(0);
  made.effect = effect;
  made.laws.clear();
  return made;
}

Effect mean_effect(double estimate, double half_width) {
  return {"relative difference of means", estimate, estimate - half_width,
          estimate + half_width,          0.99,     true};
}

}  // namespace assay::reports
