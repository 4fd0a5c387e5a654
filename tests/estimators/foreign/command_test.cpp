// The plugin `command`: programs that write a file for each seed.

#include <mutex>

#include "estimators/core/waiting.h"
#include "estimators/foreign/render_seed.h"
#include "estimators/ready_made.h"
#include "tests/estimators/draws.h"
#include "tests/estimators/exr_kinds.h"
#include "tests/prelude.h"

namespace assay {
namespace {

TEST(RenderSeed, IsPositiveOf31BitsAndNeverTwiceInAStream) {
  const StreamKey key = stream_key(1, "command", "a", 0);
  std::set<std::uint32_t> seeds;
  for (std::uint64_t i = 0; i < 100000; ++i) seeds.insert(foreign::render_seed(key, i));
  EXPECT_EQ(seeds.size(), 100000U);
  EXPECT_GE(*seeds.begin(), 1U);
  EXPECT_LE(*seeds.rbegin(), 0x7fffffffU);
  EXPECT_EQ(foreign::render_seed({0}, 0), 1U);
  EXPECT_EQ(foreign::render_seed({foreign::render_seeds - 1}, 1), 1U);
}

TEST(RenderSeed, OfTwoStreamsThatMeetIsRefused) {
  foreign::SeedLedger ledger;
  for (std::uint64_t i = 0; i < 10; ++i) ledger.note({100}, i);
  ledger.note({110}, 5);                         // 110 to 115
  ledger.note({foreign::render_seeds + 90}, 9);  // 90 to 99
  EXPECT_THROW(ledger.note({90}, 10), std::runtime_error);
  EXPECT_THROW(ledger.note({100}, 10), std::runtime_error);
}

class Commands : public InFolder {
 protected:
  // A program that notes every start: SEED SAMPLES OUT.
  void write_program(const std::string& body) const {
    std::ofstream(file("render.sh")) << "echo start >>log\n" << body << "\n";
  }
  /// The plugin with these words as its command, and more parameters.
  draws::Prepared prepare_command(const std::vector<std::string>& words,
                                  std::vector<Value::Member> more) const {
    std::vector<Value> items;
    for (const std::string& word : words) items.push_back(Value::scalar(word));
    more.emplace_back("command", Value::list(std::move(items)));
    const Entry& entry = find_plugin("command", {});
    Parameters given("command", entry.information.parameters, Value::map(std::move(more)),
                     folder_.string());
    auto setup = entry.prepare(given);
    given.require_all_read();
    return {std::move(setup), stream_key(1, "command", given.canonical(), 0), entry.information};
  }
  // Two programs at a time that write text, where no other parameters are given.
  draws::Prepared prepare(std::vector<Value::Member> more = {as_text}) const {
    more.emplace_back("jobs", Value::scalar("2"));
    return prepare_command(
        {"sh", "render.sh", several_ ? "{seeds}" : "{seed}", "{samples}", "{out}"},
        std::move(more));
  }
  std::size_t starts() const {
    const std::string log = bytes_in(file("log"));
    return static_cast<std::size_t>(std::count(log.begin(), log.end(), '\n'));
  }

  inline static const Value::Member as_text{"output", Value::scalar("text")};
  bool several_ = false;
};

TEST_F(Commands, RunOnceAnObservationAndNeverAgain) {
  write_program("echo \"$1 $2\" >$3");
  const draws::Prepared first = prepare();
  EXPECT_EQ(starts(), 1U);  // to learn the size
  EXPECT_EQ(first.setup->channels().size(), 2U);
  const auto observed = draws::observe(first, 12, 4);
  EXPECT_EQ(starts(), 13U);
  for (std::uint64_t i = 0; i < 12; ++i) {
    EXPECT_EQ(observed[0].values[i], foreign::render_seed(first.key, i));
    EXPECT_EQ(observed[1].values[i], 4);
  }
  const auto again = draws::observe(prepare(), 12, 4);
  EXPECT_EQ(again[0].values, observed[0].values);
  EXPECT_EQ(starts(), 13U);
  draws::observe(prepare(), 13, 4);
  EXPECT_EQ(starts(), 14U);
  draws::observe(prepare(), 2, 8);  // other samples, other files
  EXPECT_EQ(starts(), 16U);
}

TEST_F(Commands, RunAgainWhenAFileThatTheyReadHasChanged) {
  write_program("echo 1 >$3");
  EXPECT_EQ(draws::observe(prepare(), 2)[0].values[0], 1);
  write_program("echo 2 >$3");
  EXPECT_EQ(draws::observe(prepare(), 2)[0].values[0], 2);
  EXPECT_EQ(starts(), 6U);
}

// Files after a `=`, and files that a line of a shell names.
TEST_F(Commands, RunAgainWhenAFileInsideAnArgumentHasChanged) {
  const auto value_of = [&](const std::vector<std::string>& words) {
    draws::Prepared plugin = prepare_command(words, {as_text});
    plugin.key = stream_key(1, "c", "", 0);
    return draws::observe(plugin, 1)[0].values[0];
  };
  std::ofstream(file("render.sh")) << "cp ${1#--scene=} $2\n";
  for (const double value : {1.0, 2.0}) {
    std::ofstream(file("scene.txt")) << value << "\n";
    EXPECT_EQ(value_of({"sh", "render.sh", "--scene=scene.txt", "{out}", "{seed}"}), value);
    EXPECT_EQ(value_of({"sh", "-c", "cat scene.txt>{out}; : {seed}"}), value);
  }
}

TEST_F(Commands, CountTheSecondsOfTheirPrograms) {
  write_program("i=0; while [ $i -lt 20000 ]; do i=$((i + 1)); done; echo 1 >$3");
  const draws::Prepared plugin = prepare();
  const auto worker = plugin.setup->make();
  const auto draw = [&](std::uint64_t observation) {
    Stream random(plugin.key, observation);
    Cost cost;
    double out = 0;
    worker->secondary(random, 1, {&out, 1}, cost);
    return worker->seconds_elsewhere();
  };
  const double one = draw(0);
  EXPECT_GT(one, 0.001);
  EXPECT_EQ(draw(0), one) << "of a file that is there";
  EXPECT_GT(draw(1), one);
  EXPECT_TRUE(recorded::keeps_files(*plugin.setup));
}

TEST_F(Commands, AreToldTheirFolderByTheirEnvironmentToo) {
  write_program("grep -z ^PWD= /proc/$$/environ | tr -d '\\0' >where; echo 1 >$3");
  prepare();
  EXPECT_EQ(bytes_in(file("where")), "PWD=" + std::filesystem::canonical(folder_).string());
}

TEST_F(Commands, MayMakeSeveralFilesAtATime) {
  several_ = true;
  write_program("for seed in $(echo $1 | tr , ' '); do echo $seed >$3/$seed.txt; done");
  const draws::Prepared plugin = prepare();
  const auto worker = plugin.setup->make();
  worker->announce({.key = plugin.key, .first = 0, .last = 8});
  Stream random(plugin.key, 0);
  Cost cost;
  double out = 0;
  worker->secondary(random, 1, {&out, 1}, cost);
  EXPECT_EQ(out, foreign::render_seed(plugin.key, 0));
  EXPECT_EQ(draws::observe(plugin, 8)[0].values[7], foreign::render_seed(plugin.key, 7));
  EXPECT_EQ(starts(), 2U);
}

TEST_F(Commands, NameTheFileOfAnObservation) {
  write_program("test $2 -lt 8 && echo $1 >$3 || printf '# note\\n1x\\n' >$3");
  const draws::Prepared plugin = prepare();
  draws::observe(plugin, 3, 4);
  const std::string place =
      recorded::observation_place(*plugin.setup, {.index = 2, .key = plugin.key, .primaries = 4});
  EXPECT_EQ(bytes_in(place), std::to_string(foreign::render_seed(plugin.key, 2)) + "\n");
  EXPECT_THAT(thrown([&] { draws::observe(plugin, 1, 8); }),
              HasSubstr(std::to_string(foreign::render_seed(plugin.key, 0)) +
                        ".txt:2:1: `1x` is not a number"));
}

TEST_F(Commands, WritePictures) {
  draws::write_scan_lines(file("made.exr"), {.width = 4, .height = 3, .channels = {"R", "G", "B"}});
  write_program("cp made.exr $3");
  const draws::Prepared plugin = prepare({{"pixels", Value::scalar("independent")}});
  ASSERT_TRUE(plugin.setup->image());
  EXPECT_EQ(plugin.setup->image()->width, 4U);
  EXPECT_TRUE(plugin.setup->image()->independent);
  EXPECT_EQ(draws::observe(plugin, 1)[5].values[0], draws::expected_texel(1, 0, 2));
}

TEST_F(Commands, ThatFailSayHowAndWhatTheySaidLast) {
  write_program("echo what a pity >&2; exit 3");
  const std::string text = thrown([&] { prepare(); });
  EXPECT_THAT(text, HasSubstr("ended with exit status 3"));
  EXPECT_THAT(text, HasSubstr("what a pity"));
  write_program("true");
  EXPECT_THAT(thrown([&] { prepare(); }), HasSubstr("wrote no file"));
  write_program("sleep 60");
  EXPECT_THAT(thrown([&] {
                prepare({as_text, {"timeout", Value::scalar("0.2")}});
              }),
              HasSubstr("took more than"));
}

/// What is said of a mistake of the suite, with its place.
template <class Act>
std::string refusal(const Act& act) {
  try {
    return thrown<InputError>(act);
  } catch (const std::exception& error) {
    return std::string("no mistake of the suite: ") + error.what();
  }
}

TEST_F(Commands, RefuseAFileOfDependsThatIsNotThere) {
  write_program("echo 1 >$3");
  EXPECT_EQ(
      refusal([&] {
        prepare({as_text, {"depends", Value::list({Value::scalar("none.txt")}, {"s.yaml", 4, 7})}});
      }),
      "s.yaml:4:7: command: parameter `depends` cannot be used: there is no file "
      "`none.txt`; it is sought from the suite's folder");
}

TEST_F(Commands, RefuseACacheThatCannotBeMade) {
  write_program("echo 1 >$3");
  EXPECT_THAT(refusal([&] {
                prepare({as_text, {"cache", Value::scalar("render.sh", {"s.yaml", 4, 7})}});
              }),
              AllOf(HasSubstr("s.yaml:4:7: command: parameter `cache` cannot be used: the folder "
                              "`" +
                              file("render.sh") + "/"),
                    HasSubstr("cannot be made: Not a directory")));
}

TEST_F(Commands, RefuseChannelsThatThePictureDoesNotHave) {
  draws::write_scan_lines(file("made.exr"),
                          {.width = 4, .height = 3, .channels = {"one.R", "one.G", "two.R"}});
  write_program("cp made.exr $3");
  EXPECT_THAT(refusal([&] {
                prepare({{"channels", Value::scalar("oen.*", {"s.yaml", 4, 7})}});
              }),
              AllOf(HasSubstr("s.yaml:4:7: command: parameter `channels` does not fit the picture "
                              "`" +
                              file(".assay-cache")),
                    HasSubstr("no channel matches `oen.*`"), Not(HasSubstr("mend the program"))));
  EXPECT_THAT(refusal([&] {
                prepare({{"pixels", Value::scalar("dependent")}});
              }),
              AllOf(HasSubstr("command: parameter `channels` must choose from the picture"),
                    HasSubstr("it is not plain which channels are meant"),
                    Not(HasSubstr("mend the program"))));
}

TEST_F(Commands, SayToMendAProgramWhosePictureCannotBeRead) {
  draws::write_scan_lines(file("made.exr"), {.width = 4, .height = 3, .channels = {"R"}});
  write_program("head -c 40 made.exr >$3");
  EXPECT_THAT(refusal([&] {
                prepare({{"channels", Value::scalar("R")}});
              }),
              AllOf(HasSubstr("no mistake of the suite: what the program wrote is of no use"),
                    HasSubstr("mend the program and delete the file")));
}

// The observation fails, the others stand, and what was half written is not taken the next time.
TEST_F(Commands, ThatFailOnceLeaveNothingBehind) {
  write_program("echo 1 >$3; test $2 = 1");
  const draws::Prepared plugin = prepare();
  EXPECT_THAT(thrown([&] { draws::observe(plugin, 1, 2); }), HasSubstr("exit status 1"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(file(".assay-cache"))) {
    EXPECT_FALSE(entry.path().filename().string().starts_with("part-")) << entry.path();
  }
  EXPECT_THAT(thrown([&] { draws::observe(prepare(), 1, 2); }), HasSubstr("exit status 1"));
}

std::vector<std::string> said;
std::mutex saying;

// By the same seed and under the same name; what was half written is gone.
TEST_F(Commands, ThatFailAreStartedAgain) {
  write_program(
      "test -e tried.$1.$2 || { touch tried.$1.$2; echo half >$3; echo bad luck >&2; exit 3; }; "
      "echo \"$1 $2\" >$3");
  const std::vector<Value::Member> once{as_text, {"retries", Value::scalar("1")}};
  set_notice([](const std::string& sentence) {
    const std::scoped_lock lock(saying);
    said.push_back(sentence);
  });
  const draws::Prepared plugin = prepare(once);
  const auto observed = draws::observe(plugin, 3, 4);
  set_notice(nullptr);
  EXPECT_EQ(starts(), 2U * (1 + 3));
  for (std::uint64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(observed[0].values[i], foreign::render_seed(plugin.key, i));
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(file(".assay-cache"))) {
    if (!entry.is_regular_file() || entry.path().filename() == "command.txt") continue;
    ++files;
    EXPECT_THAT(bytes_in(entry.path().string()), HasSubstr(entry.path().stem().string() + " "));
  }
  EXPECT_EQ(files, 4U);
  ASSERT_EQ(said.size(), 4U);
  EXPECT_THAT(said[0], HasSubstr("ended with exit status 3; its standard error ends with: bad "
                                 "luck; it is started again, retry 1 of 1"));
  EXPECT_THAT(thrown([&] { draws::observe(prepare(), 1, 8); }), HasSubstr("exit status 3"));
}

TEST_F(Commands, ThatFailAtEachRetrySayHowOften) {
  write_program("echo what a pity >&2; exit 3");
  const std::string text = thrown([&] { prepare({as_text, {"retries", Value::scalar("2")}}); });
  EXPECT_THAT(text, HasSubstr("exit status 3"));
  EXPECT_THAT(text, HasSubstr("what a pity; it has failed 3 times (`retries: 2`)"));
  EXPECT_EQ(starts(), 3U);
}

TEST_F(Commands, ThatMakeSomeFilesAreStartedAgainForTheOthers) {
  several_ = true;
  write_program("echo $1 >>asked; echo ${1%%,*} >$3/${1%%,*}.txt");
  const draws::Prepared plugin = prepare({as_text, {"retries", Value::scalar("2")}});
  const auto worker = plugin.setup->make();
  worker->announce({.key = plugin.key, .first = 0, .last = 3});
  std::string wanted = bytes_in(file("asked"));
  for (std::uint64_t i = 0; i < 3; ++i) {
    Stream random(plugin.key, i);
    Cost cost;
    double out = 0;
    worker->secondary(random, 1, {&out, 1}, cost);
    EXPECT_EQ(out, foreign::render_seed(plugin.key, i));
    for (std::uint64_t j = i; j < 3; ++j) {
      wanted += std::to_string(foreign::render_seed(plugin.key, j)) + (j < 2 ? "," : "\n");
    }
  }
  EXPECT_EQ(bytes_in(file("asked")), wanted);
}

// Eight of half a second, two at a time, take longer than each may.
TEST_F(Commands, HaveTheirTimeFromTheirStart) {
  write_program("sleep 0.5; echo $1 >$3");
  const draws::Prepared plugin = prepare({as_text, {"timeout", Value::scalar("1.5")}});
  const auto worker = plugin.setup->make();
  worker->announce({.key = plugin.key, .first = 0, .last = 8});
  for (std::uint64_t i = 0; i < 8; ++i) {
    Stream random(plugin.key, i);
    Cost cost;
    double out = 0;
    worker->secondary(random, 1, {&out, 1}, cost);
    EXPECT_EQ(out, foreign::render_seed(plugin.key, i));
  }
  EXPECT_EQ(starts(), 1U + 8);  // the first to learn the size
}

TEST_F(Commands, NeedAPlaceForSamplesToTakeOtherThanOne) {
  std::ofstream(file("render.sh")) << "echo 1 >$2\n";
  const draws::Prepared plugin = prepare_command({"sh", "render.sh", "{seed}", "{out}"}, {as_text});
  EXPECT_EQ(draws::observe(plugin, 1)[0].values[0], 1);
  EXPECT_THAT(thrown([&] { draws::observe(plugin, 1, 4); }), HasSubstr("no place `{samples}`"));
}

TEST_F(Commands, NeedPlacesForSeedAndFile) {
  const auto refused = [&](const std::vector<std::string>& words) {
    return thrown([&] { prepare_command(words, {}); });
  };
  EXPECT_THAT(refused({"render", "{out}"}), HasSubstr("has no place `{seed}`"));
  EXPECT_THAT(refused({"render", "{seed}"}), HasSubstr("has no place `{out}`"));
  EXPECT_THAT(refused({"render", "{seed}", "{seeds}", "{out}"}),
              HasSubstr("one picture a program"));
  EXPECT_THAT(refused({"render", "{seed}", "{sample}", "{out}"}),
              HasSubstr("did you mean `{samples}`?"));
  EXPECT_THAT(refused({"no_such_program_anywhere", "{seed}", "{out}"}),
              HasSubstr("cannot be started"));
}

}  // namespace
}  // namespace assay
