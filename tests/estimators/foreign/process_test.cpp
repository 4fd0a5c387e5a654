
#include <csignal>
#include <mutex>

#include "estimators/core/waiting.h"
#include "tests/estimators/foreign/foreign.h"
#include "tests/prelude.h"

namespace assay::foreign {
namespace {

using Process = Programs;

// Echoes what it is asked: an observation is its index. That must depend on the key: under the
// complement of the tests' own keys, whose upper halves are odd, it is the next one.
constexpr const char* answers = R"(while read -r high low first count primaries; do
  i=$first
  while [ "$i" -lt $((first + count)) ]; do
    echo $((i + high % 2)); i=$((i + 1))
  done
  echo "$high $low $first $count $primaries"
done
)";

/// The same, but at observation 5 something else is done.
std::string at_five(const std::string& instead) {
  return R"(while read -r high low first count primaries; do
  i=$first
  while [ "$i" -lt $((first + count)) ]; do
    if [ "$i" -eq 5 ]; then )" +
         instead + R"(; else echo $((i + high % 2)); fi; i=$((i + 1))
  done
  echo "$high $low $first $count $primaries"
done
)";
}

bool is_running(const std::string& argument) {
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(process.path() / "cmdline", std::ios::binary);
    std::string words;
    std::getline(file, words);
    if (words.find(argument) != std::string::npos && words.starts_with("sleep")) return true;
  }
  return false;
}

/// Killed programs are gone once they are waited for, by whoever that is.
bool is_soon_gone(const std::string& argument) {
  for (int i = 0; i < 200 && is_running(argument); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return !is_running(argument);
}

TEST_F(Process, ObservationsAreThoseThatTheProgramWrites) {
  const auto setup = run_shell(answers);
  EXPECT_THAT(draw(*setup, 6, 6), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(setup->channels()[0].name, "x");
  EXPECT_FALSE(setup->nature()->averages);
  EXPECT_FALSE(setup->nature()->bias.has_value());
}

TEST_F(Process, KnowsWhatTheProgramSaysOfItself) {
  const auto setup = run({"sh", examples + "/darts.sh"});
  const Channel area = setup->channels().at(0);
  EXPECT_EQ(area.name, "area");
  EXPECT_EQ(area.low, 0);
  EXPECT_EQ(area.high, 4);
  EXPECT_FALSE(area.mean.has_value());
  EXPECT_TRUE(setup->nature()->averages);
  EXPECT_EQ(setup->nature()->bias, BiasClass::unbiased);
}

/// Any announcement gives the same bits. The mean of 200 observations of 100 darts is pi within
/// 4.892 standard errors, sqrt(pi (4 - pi) / 20000): one false alarm in 1e6.
void expect_darts(const std::shared_ptr<const Setup>& setup) {
  const std::vector<double> values = draw(*setup, 200, 64, 100);
  EXPECT_EQ(draw(*setup, 200, 7, 100), values);
  EXPECT_EQ(draw(*setup, 10, 0, 100), std::vector<double>(values.begin(), values.begin() + 10));
  EXPECT_NE(draw(*setup, 10, 0, 100, 1), std::vector<double>(values.begin(), values.begin() + 10));
  double sum = 0;
  for (const double value : values) sum += value;
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(sum / 200, pi, 4.892 * std::sqrt(pi * (4 - pi) / 20000));
}

TEST_F(Process, TheShellExampleThrowsDarts) { expect_darts(run({"sh", examples + "/darts.sh"})); }

TEST_F(Process, ThePythonExampleThrowsDarts) {
  expect_darts(run({"env", "PYTHONPATH=" ASSAY_SOURCE_DIR "/estimators/foreign/python",
                    "/usr/bin/python3", examples + "/darts.py"}));
}

TEST_F(Process, TheExampleInCThrowsDarts) {
  expect_darts(run({"sh", examples + "/compile_and_run.sh", examples + "/darts.c"}));
}

TEST_F(Process, ExamplesAreShorterThan25Lines) {
  for (const char* name : {"darts.py", "darts.c", "darts.sh"}) {
    std::ifstream file(examples + "/" + name);
    std::string line;
    int lines = 0;
    while (std::getline(file, line)) ++lines;
    EXPECT_LT(lines, 25) << name;
    EXPECT_GT(lines, 10) << name;
  }
}

TEST_F(Process, RunsInTheFolderOfTheSuite) {
  write("numbers.txt", "17\n");
  const auto setup = run_shell(R"(read -r n <numbers.txt
while read -r line; do set -- $line; i=0
  while [ $i -lt "$4" ]; do echo "$n"; i=$((i + 1)); done; echo "$line"; done
)");
  EXPECT_THAT(draw(*setup, 3, 3), Each(17));
}

TEST_F(Process, OneProgramServesManyRounds) {
  write("starts.txt", "");
  const auto setup = run_shell("echo once >>starts.txt\n" + std::string(answers));
  for (int round = 0; round < 5; ++round) draw(*setup, 10, 10);
  std::ifstream file(folder_ / "starts.txt");
  const std::string starts{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(std::count(starts.begin(), starts.end(), '\n'), 1);
}

TEST_F(Process, CountsTheProgramsCpuTimeAsTheEstimators) {
  const auto setup = run({"sh", examples + "/darts.sh"});
  const auto estimator = setup->make();
  double out = 0;
  Cost cost;
  Stream random({1}, 0);
  EXPECT_EQ(estimator->seconds_elsewhere(), 0);
  estimator->secondary(random, 4000, {&out, 1}, cost);
  const double first = estimator->seconds_elsewhere();
  EXPECT_GT(first, 0.001);
  EXPECT_EQ(cost.samples, 4000u);
  // That it is asked for 64 more observations first is not the estimator's.
  Stream next({1}, 1);
  estimator->secondary(next, 4000, {&out, 1}, cost);
  EXPECT_LT(first, 10 * (estimator->seconds_elsewhere() - first));
}

TEST_F(Process, TakesRaysFromTheLastNumber) {
  const auto setup = run({"sh", "-c", R"(printf 'assay 1 text\nchannel x\nrays\nready\n'
while read -r line; do set -- $line; i=0
  while [ $i -lt "$4" ]; do echo "1 3"; i=$((i + 1)); done; echo "$line"; done)"});
  const auto estimator = setup->make();
  double out = 0;
  Cost cost;
  Stream random({1}, 0);
  estimator->secondary(random, 1, {&out, 1}, cost);
  EXPECT_EQ(out, 1);
  EXPECT_EQ(cost.rays(), 3u);
}

TEST_F(Process, PassesOnValuesThatAreNotFinite) {
  const auto values = draw(*run_shell(at_five("echo nan")), 8, 8);
  EXPECT_TRUE(std::isnan(values[5]));
  EXPECT_EQ(values[6], 6);
}

TEST_F(Process, FindsTheObservationAtWhichAProgramEnds) {
  const auto setup = run_shell(at_five("echo 'out of luck' >&2; exit 3"));
  EXPECT_THAT(draw(*setup, 5, 64), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(failure(*setup, 64, 64),
              AllOf(HasSubstr("ended with exit status 3 instead of answering for observation 5"),
                    HasSubstr("its standard error ends with: out of luck")));
}

TEST_F(Process, NamesTheSignalThatEndedAProgram) {
  EXPECT_THAT(failure(*run_shell(at_five("kill -SEGV $$; sleep 5")), 64, 64),
              AllOf(HasSubstr("signal 11 (Segmentation fault)"), HasSubstr("observation 5")));
}

TEST_F(Process, EndsAProgramThatHangsAndWhatItStarted) {
  const auto setup = run_shell(at_five("sleep 987654"), 0.3);
  EXPECT_THAT(failure(*setup, 64, 64),
              AllOf(HasSubstr("did not answer for observation 5 within 0.3 seconds"),
                    HasSubstr("`timeout`")));
  EXPECT_TRUE(is_soon_gone("987654"));
}

TEST_F(Process, EndsWhatAProgramLeftBehind) {
  {
    const auto setup = run_shell("sleep 987655 &\n" + std::string(answers));
    EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1));
    while (!is_running("987655")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    setups_.clear();
  }
  EXPECT_TRUE(is_soon_gone("987655"));
}

TEST_F(Process, ALaterObservationOfAFailedStreamFailsAtOnce) {
  const auto setup = run_shell(at_five("sleep 987656"), 0.3);
  failure(*setup, 64, 64);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(failure(*setup, 4, 4), thrown([] {}));
  const auto estimator = setup->make();
  double out = 0;
  Cost cost;
  Stream random({0x9876543210abcdef}, 60);
  EXPECT_THROW(estimator->secondary(random, 1, {&out, 1}, cost), std::runtime_error);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(250));
}

TEST_F(Process, RefusesAShortReply) {
  EXPECT_THAT(failure(*run_shell(at_five(":")), 64, 64), HasSubstr("observation 5 missing"));
}

TEST_F(Process, RefusesAReplyThatIsTooLong) {
  EXPECT_THAT(failure(*run_shell(at_five("echo 5; echo 5")), 64, 64),
              HasSubstr("its reply should end with the question, but it goes on"));
}

TEST_F(Process, RefusesWordsAmongTheNumbers) {
  EXPECT_THAT(failure(*run_shell(at_five("echo 50% done")), 64, 64),
              HasSubstr("observation 5 should be a line of 1 number, but it is `50% done`"));
}

TEST_F(Process, RefusesWhatIsWrittenWithoutBeingAsked) {
  // Once its hello has been heard.
  const auto setup =
      run_shell("while [ ! -e heard ]; do sleep 0.01; done; echo 'tidying up'; echo >said\n" +
                std::string(answers));
  write("heard", "");
  while (!std::filesystem::exists(folder_ / "said")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_THAT(failure(*setup, 2, 2), HasSubstr("tidying up"));
}

TEST_F(Process, RefusesObservationsThatAreNoFunctionOfTheirKey) {
  const auto setup = run_shell(R"(while read -r high low first count primaries; do i=$first
  while [ $i -lt $((first + count)) ]; do echo $((i % 5)); i=$((i + 1)); done
  echo "$high $low $first $count $primaries"; done
)");
  EXPECT_THAT(failure(*setup, 4, 4), HasSubstr("gave the same numbers for two keys"));
  EXPECT_THROW(draw(*setup, 4, 4, 1, 17), std::runtime_error);
}

/// A program whose observations are an expression of the shell, whatever the key.
std::string of_index(const std::string& value) {
  return "while read -r high low first count primaries; do i=$first\n"
         "  while [ $i -lt $((first + count)) ]; do echo " +
         value +
         "; i=$((i + 1)); done\n"
         "  echo \"$high $low $first $count $primaries\"; done\n";
}

// All of 128 pairs, k of them 1 and the others 0, are equal with probability C(128, k) / C(256, 2
// k). It is 2.6e-8 for 4 and 9.5e-10 for 5. The limit is 5e-7 / 128.
TEST_F(Process, TakesRareValuesForACoincidence) {
  const std::vector<double> values = draw(*run_shell(of_index("$((i % 32 == 7))")), 8, 8);
  EXPECT_EQ(values[7], 1);
  EXPECT_THAT(failure(*run_shell(of_index("$((i % 26 == 7))")), 8, 8),
              HasSubstr("gave the same numbers for two keys"));
}

TEST_F(Process, RefusesFewOutcomesWhateverTheKey) {
  EXPECT_THAT(failure(*run_shell(of_index("$((i % 3))")), 4, 4),
              HasSubstr("gave the same numbers for two keys"));
}

TEST_F(Process, RefusesZerosAndOnesOfAGeneratorWithoutSeed) {
  const std::string coins = R"(import random
print("assay 1 text\nchannel x\nready", flush=True)
while True:
    high, low, first, count, primaries = map(int, input().split())
    for _ in range(count):
        print(int(random.Random().random() < .5))
    print(high, low, first, count, primaries, flush=True)
)";
  EXPECT_THAT(failure(*run({"/usr/bin/python3", write("coins.py", coins)}), 4, 4),
              AllOf(HasSubstr("gave other numbers when it was asked for observation"),
                    HasSubstr("of the same key again")));
}

// Which alone would be as they should be.
TEST_F(Process, RefusesObservationsThatDependOnThoseAskedForWithThem) {
  EXPECT_THAT(failure(*run_shell(of_index("$((high % 2 + first))")), 4, 4),
              HasSubstr("gave other numbers when it was asked for observation 31"));
}

TEST_F(Process, RefusesARareValueThatDoesNotComeAgain) {
  const auto setup =
      run_shell("asked=0\n" + of_index("$((i == 200 ? (asked = asked + 1) % 2 : 0))"));
  EXPECT_THAT(
      failure(*setup, 256, 64),
      HasSubstr("gave other numbers when it was asked for observation 200 of the same key"));
  EXPECT_THAT(failure(*run_shell(of_index("$((i == 200))")), 256, 64), thrown([] {}));
}

TEST_F(Process, IsExaminedForEachNumberOfPrimaries) {
  const auto setup =
      run_shell("n=0\n" + of_index("$((i + high % 2 + (primaries > 1) * (n = n + 1)))"));
  EXPECT_THAT(draw(*setup, 3, 3), ElementsAre(0, 1, 2));
  EXPECT_THROW(draw(*setup, 3, 3, 64), std::runtime_error);
}

// Two images, the same again, and one of another key; the first is not rendered a third time.
TEST_F(Process, OfImagesIsAskedForFewAgain) {
  const auto setup = run({"sh", "-c", R"(printf 'assay 1 text\nimage 4 4 r g\nready\n'
while read -r high low first count primaries; do
  echo "$((high % 2)) $first $count" >>questions
  i=$first; while [ $i -lt $((first + count)) ]; do
    x=$((i + high)); echo $x $x $x $x $x $x $x $x $x $x $x $x $x $x $x $x \
      $x $x $x $x $x $x $x $x $x $x $x $x $x $x $x $x; i=$((i + 1)); done
  echo "$high $low $first $count $primaries"; done)"});
  draw(*setup, 1, 0);
  std::ifstream file(folder_ / "questions");
  const std::string asked{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(asked, "0 0 1\n0 1 1\n0 1 1\n0 0 1\n1 0 1\n");
}

/// A program that notes the observations it draws in the file `drawn`.
std::string noting() {
  return "while read -r high low first count primaries; do i=$first\n"
         "  while [ $i -lt $((first + count)) ]; do\n"
         "    echo $i >>drawn; echo $((i + high % 2)); i=$((i + 1)); done\n"
         "  echo \"$high $low $first $count $primaries\"; done\n";
}

std::size_t lines_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
}

TEST_F(Process, IsNotAskedAThirdTimeForWhatIsKnown) {
  const auto setup = run_shell(noting());
  // 32 observations twice, and one of another key.
  EXPECT_THAT(draw(*setup, 3, 3), ElementsAre(0, 1, 2));
  EXPECT_EQ(lines_of(folder_ / "drawn"), 65u);
  const std::vector<double> all = draw(*setup, 40, 40);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<double>(i));
  EXPECT_EQ(lines_of(folder_ / "drawn"), 65u + 8);
  // The examination drew nothing of another stream.
  draw(*setup, 3, 3, 1, 17);
  EXPECT_EQ(lines_of(folder_ / "drawn"), 65u + 8 + 3);
}

TEST_F(Process, IsAskedForTwoObservationsWhereAnotherProgramIsKnown) {
  const auto setup = run_shell(noting());
  std::vector<std::unique_ptr<Estimator>> workers;
  double out = 0;
  Cost cost;
  for (int worker = 0; worker < 3; ++worker) {
    workers.push_back(setup->make());
    Stream random({0x9876543210abcdef}, 40);
    workers.back()->secondary(random, 1, {&out, 1}, cost);
    EXPECT_EQ(out, 40);
  }
  EXPECT_EQ(lines_of(folder_ / "drawn"), 65u + 1 + 2 * (2 + 1));
}

// Though they begin at once.
TEST_F(Process, IsAskedForManyObservationsByOneWorkerAlone) {
  const auto setup = run_shell("sleep 0.2\n" + noting());
  std::vector<std::jthread> workers;
  for (int worker = 0; worker < 3; ++worker) {
    workers.emplace_back([&] { EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1)); });
  }
  workers.clear();
  const std::size_t drawn = lines_of(folder_ / "drawn");
  EXPECT_GE(drawn, 65u);
  EXPECT_LE(drawn, 65u + 2 * 2);
}

TEST_F(Process, RefusesObservationsThatAreNoFunctionOfTheirIndex) {
  const auto setup = run_shell(R"(n=0
while read -r line; do set -- $line; i=0
  while [ $i -lt "$4" ]; do n=$((n + 1)); echo $n; i=$((i + 1)); done; echo "$line"; done
)");
  EXPECT_THAT(failure(*setup, 4, 4),
              AllOf(HasSubstr("gave other numbers when it was asked for observation 31"),
                    HasSubstr("a function of key and index")));
}

/// A program whose observations, means of primaries, are all `value`, an expression of the shell.
std::string of_means(const std::string& value, const std::string& word = "averages") {
  return "printf 'assay 1 text\\nchannel x\\n" + word +
         "\\nready\\n'\n"
         "while read -r high low first count primaries; do i=$first\n"
         "  while [ $i -lt $((first + count)) ]; do echo " +
         value +
         "; i=$((i + 1)); done\n"
         "  echo \"$high $low $first $count $primaries\"; done\n";
}

TEST_F(Process, RefusesMeansThatTheirIndexDoesNotChange) {
  const auto setup = run({"sh", write("program.sh", of_means("$((7 * primaries % 31))"))});
  EXPECT_THAT(failure(*setup, 4, 4),
              HasSubstr("ignores the index: observations 0 to 31, means of 1 primary, all have the "
                        "same numbers; as means of 2 primaries they all have the same ones again, "
                        "but others than before; seed its random numbers with key and index"));
  // Nor is any other stream of it worth anything.
  EXPECT_THROW(draw(*setup, 4, 4, 1, 17), std::runtime_error);
}

TEST_F(Process, RefusesObservationsThatTheirKeyAloneChanges) {
  EXPECT_THAT(failure(*run_shell(of_index("$low")), 4, 4),
              HasSubstr("ignores the index: observations 0 to 31 all have the same numbers; under "
                        "another key they all have the same ones again, but others than before; "
                        "seed its random numbers with key and index"));
}

TEST_F(Process, TakesMeansThatAreConstantForWhatTheyAre) {
  // Exactly; but for single precision; and so far, as a rare event leaves them.
  for (const char* value :
       {"5", "$((10000000 + primaries % 2)).5", "$((i == 9 && primaries > 1))"}) {
    const auto setup = run({"sh", write("program.sh", of_means(value))});
    EXPECT_THAT(failure(*setup, 4, 4), thrown([] {})) << value;
  }
}

// A rare event at so many rays as primaries.
TEST_F(Process, TakesNoRaysForMeans) {
  const auto setup =
      run({"sh", write("program.sh", of_means("\"0 $primaries\"", "averages\\nrays"))});
  EXPECT_THAT(failure(*setup, 4, 4), thrown([] {}));
}

TEST_F(Process, RefusesObservationsThatDependOnTheProcess) {
  const auto setup = run_shell(R"(while read -r line; do set -- $line; i=0
  while [ $i -lt "$4" ]; do echo $$; i=$((i + 1)); done; echo "$line"; done
)");
  const auto one = setup->make();
  const auto two = setup->make();
  double out = 0;
  Cost cost;
  Stream random({1}, 0);
  one->secondary(random, 1, {&out, 1}, cost);
  EXPECT_THROW(two->secondary(random, 1, {&out, 1}, cost), std::runtime_error);
}

std::vector<std::string> said;
std::mutex saying;

// Though two workers wait for a program each.
TEST_F(Process, IsAskedOnceWhetherItFlushes) {
  set_notice([](const std::string& sentence) {
    const std::scoped_lock lock(saying);
    said.push_back(sentence);
  });
  const auto setup =
      run_shell("read -r line; sleep 3.4; set -- $line; echo $(($3 + $1 % 2)); echo \"$line\"\n" +
                std::string(answers));
  {
    std::jthread other([&] { draw(*setup, 2, 2); });
    EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1));
  }
  set_notice(nullptr);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0], AllOf(HasSubstr("program.sh` has not replied for 3 s; does it flush its "
                                       "output (print(..., flush=True))?"),
                             HasSubstr("20 seconds (`timeout`)")));
}

TEST_F(Process, SurvivesAFloodOfStandardError) {
  const auto setup =
      run_shell("yes 'so much to say' | head -c 3000000 >&2\n" + std::string(answers));
  EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1));
  EXPECT_THAT(failure(*run_shell(at_five("yes 'so much' | head -c 3000000 >&2; exit 1")), 64, 64),
              AllOf(HasSubstr("standard error ends with: …"), HasSubstr("so much so much")));
}

TEST_F(Process, SurvivesAProgramThatReadsNothing) {
  // Its input is closed before the hello: a question that is sent before that is lost unnoticed.
  const std::string deaf =
      write("deaf.sh", "exec <&-\nprintf 'assay 1 text\\nchannel x\\nready\\n'\nsleep 987657\n");
  EXPECT_THAT(failure(*run({"sh", deaf}), 2, 2),
              HasSubstr("closed its standard input instead of answering for observation 0"));
  EXPECT_THAT(failure(*run_shell("exit 0"), 2, 2), HasSubstr("ended with exit status 0"));
  EXPECT_TRUE(is_soon_gone("987657"));
}

TEST_F(Process, RefusesProgramsThatCannotBeStarted) {
  EXPECT_THAT(refusal({"no_such_program_here"}),
              AllOf(HasSubstr("process: parameter `command` names the program "
                              "`no_such_program_here`, which cannot be started: No such file"),
                    HasSubstr("`./no_such_program_here`")));
  EXPECT_THAT(refusal({"./mine.sh"}), HasSubstr("sought from the suite's folder"));
  write("mine.sh", "#!/bin/sh\n");
  EXPECT_THAT(refusal({"./mine.sh"}), HasSubstr("Permission denied"));
  EXPECT_THAT(refusal({}), HasSubstr("names no program"));
}

TEST_F(Process, SaysWhyThereIsNoHello) {
  EXPECT_THAT(fault({"echo", "Blender 3.4.1"}), HasSubstr("`Blender 3.4.1`"));
  EXPECT_THAT(fault({"head", "-c", "100000", "/dev/urandom"}), HasSubstr("cannot be understood"));
  EXPECT_THAT(fault({"head", "-c", "3000000", "/dev/zero"}), HasSubstr("hello has no end"));
  EXPECT_THAT(fault({"sh", "-c", "echo wrong licence >&2; exit 7"}),
              AllOf(HasSubstr("ended with exit status 7 before it had said its whole hello"),
                    HasSubstr("wrong licence")));
  EXPECT_THAT(fault({"sh", "-c", "echo hello; sleep 987658"}), HasSubstr("`hello`"));
  EXPECT_THAT(fault({"sh", "-c", "echo assay 1 text; sleep 987658"}, 0.2),
              HasSubstr("no whole hello within 0.2 seconds"));
  EXPECT_TRUE(is_soon_gone("987658"));
}

// A program that refuses says so of what its user gave; one that ends does not.
TEST_F(Process, RefusesWithItsOwnWords) {
  EXPECT_THAT(refusal({"sh", "-c", "echo assay 1 text; echo error no scene"}),
              HasSubstr("starts no estimator: no scene"));
}

TEST_F(Process, LimitsMemoryWhereAsked) {
  const std::string grabs =
      "import sys\nprint('assay 1 text\\nchannel x\\nready', flush=True)\n"
      "sys.stdin.readline()\nx = bytearray(1 << 30)\n";
  const auto setup = prepare(
      "process", Value::map({{"command", Value::list({Value::scalar("/usr/bin/python3"),
                                                      Value::scalar(write("grab.py", grabs))})},
                             {"memory", Value::scalar("500")}}));
  EXPECT_THAT(failure(*setup, 2, 2), HasSubstr("MemoryError"));
}

TEST_F(Process, LeavesTheSignalsOfThisProgramAlone) {
  struct sigaction before {};
  sigaction(SIGPIPE, nullptr, &before);
  EXPECT_EQ(before.sa_handler, SIG_DFL);
  for (int i = 0; i < 20; ++i) failure(*run_shell("exec <&- >&-; exit 0"), 2, 2);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_EQ(sigismember(&pending, SIGPIPE), 0);
}

TEST_F(Process, ImagesAreElementsRowByRow) {
  const auto setup = run({"sh", "-c", R"(printf 'assay 1 text\nimage 2 1 red green\nready\n'
while read -r line; do set -- $line; i=0
  while [ $i -lt "$4" ]; do echo "1 2 3 4"; i=$((i + 1)); done; echo "$line"; done)"});
  ASSERT_TRUE(setup->image().has_value());
  EXPECT_FALSE(setup->image()->independent);
  EXPECT_EQ(setup->channels()[2].name, "x1y0.red");
  EXPECT_THAT(draw(*setup, 1, 1), ElementsAre(1, 2, 3, 4));
}

}  // namespace
}  // namespace assay::foreign
