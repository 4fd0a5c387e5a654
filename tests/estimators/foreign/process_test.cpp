#include <csignal>
#include <mutex>

#include "estimators/core/waiting.h"
#include "tests/estimators/foreign/foreign.h"

namespace assay::foreign {
namespace {

using Process = Programs;

// An observation is its index. That must depend on the key: under the complement of the tests' own
// keys, whose upper halves are odd, it is the next one.
const std::string answers = for_each("echo $((i + high % 2))");

/// The same, but at observation 5 something else is done.
std::string at_five(const std::string& instead) {
  return for_each("if [ $i -eq 5 ]; then " + instead + "; else echo $((i + high % 2)); fi");
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

// Any announcement gives the same bits. The mean of 200 observations of 100 darts is pi
// within 4.892 standard errors, sqrt(pi (4 - pi) / 20000): one false alarm in 1e6. The claims of
// tests/cli/foreign_test.sh are about the examples in other languages too.
TEST_F(Process, TheShellExampleThrowsDarts) {
  const auto setup = run({"sh", examples + "/darts.sh"});
  const std::vector<double> values = draw(*setup, 200, 64, 100);
  EXPECT_EQ(draw(*setup, 200, 7, 100), values);
  EXPECT_EQ(draw(*setup, 10, 0, 100), std::vector<double>(values.begin(), values.begin() + 10));
  EXPECT_NE(draw(*setup, 10, 0, 100, 1), std::vector<double>(values.begin(), values.begin() + 10));
  EXPECT_NEAR(std::accumulate(values.begin(), values.end(), 0.0) / 200, pi,
              4.892 * std::sqrt(pi * (4 - pi) / 20000));
}

std::size_t lines_of(const std::filesystem::path& path) {
  const std::string bytes = bytes_in(path);
  return static_cast<std::size_t>(std::ranges::count(bytes, '\n'));
}

TEST_F(Process, ExamplesAreShorterThan25Lines) {
  for (const char* name : {"darts.py", "darts.c", "darts.sh"}) {
    EXPECT_THAT(lines_of(examples + "/" + name), AllOf(Lt(25U), Gt(10U))) << name;
  }
}

TEST_F(Process, RunsInTheFolderOfTheSuite) {
  write("numbers.txt", "17\n");
  EXPECT_THAT(draw(*run_shell("read -r n <numbers.txt\n" + for_each("echo $n")), 3, 3), Each(17));
}

TEST_F(Process, OneProgramServesManyRounds) {
  const auto setup = run_shell("echo once >>starts.txt\n" + answers);
  for (int round = 0; round < 5; ++round) draw(*setup, 10, 10);
  EXPECT_EQ(lines_of(file("starts.txt")), 1U);
}

TEST_F(Process, CountsTheProgramsCpuTimeAsTheEstimators) {
  const auto setup = run({"sh", examples + "/darts.sh"});
  const auto estimator = setup->make();
  Cost cost;
  EXPECT_EQ(estimator->seconds_elsewhere(), 0);
  draw_one(*estimator, 0, 4000, cost);
  const double first = estimator->seconds_elsewhere();
  EXPECT_GT(first, 0.001);
  EXPECT_EQ(cost.samples, 4000u);
  // That it is asked for 64 more observations first is not the estimator's.
  draw_one(*estimator, 1, 4000, cost);
  EXPECT_LT(first, 10 * (estimator->seconds_elsewhere() - first));
}

TEST_F(Process, TakesRaysFromTheLastNumber) {
  const auto setup = run_shell(for_each("echo 1 3"), 20, "channel x\\nrays");
  Cost cost;
  EXPECT_EQ(draw_one(*setup->make(), 0, 1, cost), 1);
  EXPECT_EQ(cost.rays(), 3u);
}

TEST_F(Process, PassesOnValuesThatAreNotFinite) {
  const auto values = draw(*run_shell(at_five("echo nan")), 8, 8);
  EXPECT_TRUE(std::isnan(values[5]));
  EXPECT_EQ(values[6], 6);
}

TEST_F(Process, FindsTheObservationAtWhichAReplyGoesWrong) {
  EXPECT_THAT(draw(*run_shell(at_five("exit 3")), 5, 64), ElementsAre(0, 1, 2, 3, 4));
  using Words = std::vector<std::string>;
  for (const auto& [instead, words] : std::map<std::string, Words>{
           {"echo 'out of luck' >&2; exit 3",
            {"ended with exit status 3 instead of answering for observation 5",
             "its standard error ends with: out of luck"}},
           {"kill -SEGV $$; sleep 5", {"signal 11 (Segmentation fault)", "observation 5"}},
           {":", {"lacks observation 5"}},
           {"echo 5; echo 5", {"its reply should end with the question, but it goes on"}},
           {"echo 50% done", {"observation 5 should be a line of 1 number, but it is `50% done`"}},
           {"yes 'so much' | head -c 3000000 >&2; exit 1",
            {"standard error ends with: so much; before that: … so much so much"}},
           {"printf 'Traceback:\\n at work\\nout of luck\\n\\n' >&2; exit 1",
            {"standard error ends with: out of luck; before that: Traceback: at work"}}}) {
    const std::string said = failure(*run_shell(at_five(instead)), 64, 64);
    for (const std::string& part : words) EXPECT_THAT(said, HasSubstr(part)) << instead;
    setups_.clear();
  }
}

TEST_F(Process, EndsAProgramThatHangsAndWhatItStarted) {
  const auto setup = run_shell(at_five("sleep 987654"), 0.3);
  EXPECT_THAT(failure(*setup, 64, 64),
              Says("did not answer for observation 5 within 0.3 seconds", "`timeout`"));
  EXPECT_TRUE(is_soon_gone("987654"));
  // A later observation of the stream fails at once.
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(failure(*setup, 4, 4), thrown([] {}));
  EXPECT_THROW(draw_one(*setup->make(), 60, 0x9876543210abcdef), std::runtime_error);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(250));
}

TEST_F(Process, EndsWhatAProgramLeftBehind) {
  {
    const auto setup = run_shell("sleep 987655 &\n" + answers);
    EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1));
    while (!is_running("987655")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    setups_.clear();
  }
  EXPECT_TRUE(is_soon_gone("987655"));
}

TEST_F(Process, RefusesWhatIsWrittenWithoutBeingAsked) {
  // Once its hello has been heard.
  const auto setup = run_shell(
      "while [ ! -e heard ]; do sleep 0.01; done; echo 'tidying up'; echo >said\n" + answers);
  write("heard", "");
  while (!std::filesystem::exists(folder_ / "said")) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_THAT(failure(*setup, 2, 2), HasSubstr("tidying up"));
}

// A case is echoed for each observation. All of 128 pairs, k of them 1 and the others 0, are equal
// with probability C(128, k) / C(256, 2 k). It is 2.6e-8 for 4 and 9.5e-10 for 5; the limit is 5e-7
// / 128.
TEST_F(Process, RefusesObservationsThatAreNoFunctionOfKeyAndIndex) {
  const std::string two_keys = "gave the same numbers for two keys";
  const std::string again = "gave other numbers when it was asked for observation ";
  const std::string nothing = thrown([] {});
  struct Case {
    const char* value;
    std::string said;
    std::string channel = "channel x";
  };
  const std::string averages = "channel x\\naverages";
  for (const auto& [value, said, channel] : std::vector<Case>{
           {"$((i % 5))", two_keys},
           {"$((i % 3))", two_keys},
           {"$((i % 26 == 7))", two_keys},
           {"$((i % 32 == 7))", nothing},
           // Which alone would be as it should be.
           {"$((high % 2 + first))", again + "31"},
           {"$((n = n + 1))", again + "31"},
           {"$((n = n + 1))", "a function of key and index"},
           // A rare value that does not come again.
           {"$((i == 200 ? (n = n + 1) % 2 : 0))", again + "200 again"},
           {"$((i == 200))", nothing},
           {"$low",
            "ignores the index: observations 0 to 31 all have the same numbers; under another key "
            "they all have the same ones again, but others than before; take random numbers only "
            "from a generator seeded with key and index (in Python: from `rng`)"},
           {"$((7 * primaries % 31))",
            "ignores the index: observations 0 to 31, means of 1 primary, all have the same "
            "numbers; as means of 2 primaries they all have the same ones again, but others than "
            "before; take random numbers only from a generator seeded with key and index",
            averages},
           // Constant; but for single precision; and so far, as a rare event leaves them.
           {"5", nothing, averages},
           {"$((10000000 + primaries % 2)).5", nothing, averages},
           {"$((i == 9 && primaries > 1))", nothing, averages},
           // A rare event at so many rays as primaries.
           {"0 $primaries", nothing, averages + "\\nrays"}}) {
    const auto setup =
        run_shell("n=0\n" + for_each("echo \"" + std::string(value) + "\""), 20, channel);
    EXPECT_THAT(failure(*setup, 256, 64), HasSubstr(said)) << value;
    // Nor is any other stream of it worth anything.
    if (said != nothing) {
      EXPECT_THROW(draw(*setup, 4, 4, 1, 17), std::runtime_error) << value;
    }
    setups_.clear();
  }
}

// Twice as many primaries are asked for once to see whether they count. That is no examination of
// observations of so many.
TEST_F(Process, IsExaminedAtEachNumberOfPrimaries) {
  const std::string averages = "channel x\\naverages";
  const auto rare = run_shell(for_each("echo $((i == 40))"), 20, averages);
  draw(*rare, 4, 4, 1);
  EXPECT_EQ(draw(*rare, 64, 64, 2)[40], 1);
  const auto counts =
      run_shell("n=0\n" + for_each("echo $((primaries == 2 ? (n = n + 1) : 5))"), 20, averages);
  draw(*counts, 4, 4, 1);
  EXPECT_THAT(thrown([&] { draw(*counts, 4, 4, 2); }), HasSubstr("gave other numbers"));
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
  EXPECT_THAT(
      failure(*run({"/usr/bin/python3", write("coins.py", coins)}), 4, 4),
      Says("gave other numbers when it was asked for observation", " again: an observation"));
}

TEST_F(Process, IsExaminedForEachNumberOfPrimaries) {
  const auto setup =
      run_shell("n=0\n" + for_each("echo $((i + high % 2 + (primaries > 1) * (n = n + 1)))"));
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
  EXPECT_EQ(bytes_in(file("questions")), "0 0 1\n0 1 1\n0 1 1\n0 0 1\n1 0 1\n");
}

/// A program that notes the observations it draws in the file `drawn`.
const std::string noting = for_each("echo $i >>drawn; echo $((i + high % 2))");

TEST_F(Process, IsNotAskedAThirdTimeForWhatIsKnown) {
  const auto setup = run_shell(noting);
  // 32 observations twice, and one of another key.
  EXPECT_THAT(draw(*setup, 3, 3), ElementsAre(0, 1, 2));
  EXPECT_EQ(lines_of(file("drawn")), 65u);
  const std::vector<double> all = draw(*setup, 40, 40);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], static_cast<double>(i));
  EXPECT_EQ(lines_of(file("drawn")), 65u + 8);
  // The examination drew nothing of another stream.
  draw(*setup, 3, 3, 1, 17);
  EXPECT_EQ(lines_of(file("drawn")), 65u + 8 + 3);
}

TEST_F(Process, IsAskedForTwoObservationsWhereAnotherProgramIsKnown) {
  const auto setup = run_shell(noting);
  std::vector<std::unique_ptr<Estimator>> workers;
  for (int worker = 0; worker < 3; ++worker) {
    workers.push_back(setup->make());
    EXPECT_EQ(draw_one(*workers.back(), 40, 0x9876543210abcdef), 40);
  }
  EXPECT_EQ(lines_of(file("drawn")), 65u + 1 + 2 * (2 + 1));
}

// Though they begin at once.
TEST_F(Process, IsAskedForManyObservationsByOneWorkerAlone) {
  const auto setup = run_shell("sleep 0.2\n" + noting);
  std::vector<std::jthread> workers;
  for (int worker = 0; worker < 3; ++worker) {
    workers.emplace_back([&] { EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1)); });
  }
  workers.clear();
  const std::size_t drawn = lines_of(file("drawn"));
  EXPECT_GE(drawn, 65u);
  EXPECT_LE(drawn, 65u + 2 * 2);
}

TEST_F(Process, RefusesObservationsThatDependOnTheProcess) {
  const auto setup = run_shell(for_each("echo $$"));
  const auto one = setup->make();
  const auto two = setup->make();
  draw_one(*one, 0);
  EXPECT_THROW(draw_one(*two, 0), std::runtime_error);
}

// Though two workers wait for a program each.
TEST_F(Process, IsAskedOnceWhetherItFlushes) {
  static std::vector<std::string> said;
  static std::mutex saying;
  set_notice([](const std::string& sentence) {
    const std::scoped_lock lock(saying);
    said.push_back(sentence);
  });
  const auto setup = run_shell(
      "read -r line; sleep 3.4; set -- $line; echo $(($3 + $1 % 2)); echo \"$line\"\n" + answers);
  {
    std::jthread other([&] { draw(*setup, 2, 2); });
    EXPECT_THAT(draw(*setup, 2, 2), ElementsAre(0, 1));
  }
  set_notice(nullptr);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0], Says("program.sh` has not replied for 3 s; does it flush its "
                            "output (print(..., flush=True))?",
                            "20 seconds (`timeout`)"));
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
              Says("process: parameter `command` names the program "
                   "`no_such_program_here`, which cannot be started: No such file",
                   "`./no_such_program_here`"));
  EXPECT_THAT(refusal({"./mine.sh"}), HasSubstr("starts at the suite's folder"));
  EXPECT_THAT(refusal({"python3 ok.py  uniform"}),
              HasSubstr("put commas between the words: `[python3, ok.py, uniform]`"));
  write("mine.sh", "#!/bin/sh\n");
  EXPECT_THAT(refusal({"./mine.sh"}), HasSubstr("Permission denied"));
  EXPECT_THAT(refusal({}), HasSubstr("names no program"));
}

TEST_F(Process, SaysWhyThereIsNoHello) {
  EXPECT_THAT(fault({"echo", "Blender 3.4.1"}), HasSubstr("`Blender 3.4.1`"));
  const std::string junk = R"(printf '\351\377\n'; head -c 100000 /dev/zero)";
  EXPECT_THAT(fault({"sh", "-c", junk}), HasSubstr("cannot be understood"));
  EXPECT_THAT(fault({"head", "-c", "3000000", "/dev/zero"}), HasSubstr("hello has no end"));
  EXPECT_THAT(fault({"sh", "-c", "echo wrong licence >&2; exit 7"}),
              Says("ended with exit status 7 before it printed the line `ready`", "wrong licence"));
  EXPECT_THAT(fault({"sh", "-c", "echo hello; sleep 987658"}), HasSubstr("`hello`"));
  EXPECT_THAT(fault({"sh", "-c", "echo assay 1 text; sleep 987658"}, 0.2),
              HasSubstr("did not print the line `ready` within 0.2 seconds"));
  EXPECT_TRUE(is_soon_gone("987658"));
  // A program that refuses says so of what its user gave; one that ends does not.
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
  const auto setup = run_shell(for_each("echo 1 2 3 4 5"), 20,
                               "image 2 1 red green\nrange 0 9\nchannel misses diagnostic");
  ASSERT_TRUE(setup->image().has_value());
  EXPECT_FALSE(setup->image()->independent);
  EXPECT_EQ(setup->channels()[2].name, "x1y0.red");
  EXPECT_EQ(setup->channels()[2].high, 9);
  EXPECT_EQ(setup->channels().at(4).name, "misses");
  EXPECT_THAT(draw(*setup, 1, 1), ElementsAre(1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace assay::foreign
