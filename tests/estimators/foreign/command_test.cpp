// The plugin `command`: programs that write a file for each seed.

#include <mutex>

#include "estimators/core/waiting.h"
#include "estimators/foreign/renderings.h"
#include "tests/estimators/exr_kinds.h"
#include "tests/estimators/prelude.h"

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
    return draws::prepare("command", Value::map(std::move(more)), folder_.string());
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
    return static_cast<std::size_t>(std::ranges::count(log, '\n'));
  }
  /// Why the plugin is refused, with the place; of other faults it is said that they are no mistake
  /// of the suite.
  std::string refusal(std::vector<Value::Member> more) const {
    try {
      prepare(std::move(more));
    } catch (const InputError& error) {
      return error.what();
    } catch (const std::exception& error) {
      return std::string("no mistake of the suite: ") + error.what();
    }
    return "nothing was refused";
  }
  static double observe_by(Estimator& worker, StreamKey key, std::uint64_t index) {
    Stream random(key, index);
    Cost cost;
    double out = 0;
    worker.secondary(random, 1, {&out, 1}, cost);
    return out;
  }
  /// Observation `index` is the seed of its program.
  static void expect_seed(const draws::Prepared& plugin, Estimator& worker, std::uint64_t index) {
    EXPECT_EQ(observe_by(worker, plugin.key, index), foreign::render_seed(plugin.key, index));
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
    observe_by(*worker, plugin.key, observation);
    return worker->seconds_elsewhere();
  };
  const double one = draw(0);
  EXPECT_GT(one, 0.001);
  EXPECT_EQ(draw(0), one) << "of a file that is there";
  EXPECT_GT(draw(1), one);
  EXPECT_TRUE(plugin.setup->keeps_files());
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
  expect_seed(plugin, *worker, 0);
  EXPECT_EQ(draws::observe(plugin, 8)[0].values[7], foreign::render_seed(plugin.key, 7));
  EXPECT_EQ(starts(), 2U);
}

TEST_F(Commands, NameTheFileOfAnObservation) {
  write_program("test $2 -lt 8 && echo $1 >$3 || printf '# note\\n1x\\n' >$3");
  const draws::Prepared plugin = prepare();
  draws::observe(plugin, 3, 4);
  const std::string place = plugin.setup->place_of({.index = 2, .key = plugin.key, .primaries = 4});
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
  EXPECT_THAT(refusal({as_text}), Says("ended with exit status 3", "what a pity"));
  EXPECT_THAT(refusal({as_text, {"retries", Value::scalar("2")}}),
              Says("exit status 3", "what a pity; it has failed 3 times (`retries: 2`)"));
  EXPECT_EQ(starts(), 1U + 3);
  write_program("true");
  EXPECT_THAT(refusal({as_text}), HasSubstr("wrote no file"));
  write_program("sleep 60");
  EXPECT_THAT(refusal({as_text, {"timeout", Value::scalar("0.2")}}), HasSubstr("took more than"));
}

TEST_F(Commands, RefuseChannelsThatThePictureDoesNotHave) {
  draws::write_scan_lines(file("made.exr"),
                          {.width = 4, .height = 3, .channels = {"one.R", "one.G", "two.R"}});
  write_program("cp made.exr $3");
  EXPECT_THAT(
      refusal({{"channels", Value::scalar("oen.*", {"s.yaml", 4, 7})}}),
      AllOf(HasSubstr("s.yaml:4:7: command: parameter `channels` does not fit the picture `" +
                      file(".assay-cache")),
            HasSubstr("no channel matches `oen.*`"), Not(HasSubstr("correct the program"))));
  EXPECT_THAT(refusal({{"pixels", Value::scalar("dependent")}}),
              AllOf(HasSubstr("command: parameter `channels` must choose from the picture"),
                    HasSubstr("it is not clear which channels to use"),
                    Not(HasSubstr("correct the program"))));
  write_program("head -c 40 made.exr >$3");
  EXPECT_THAT(refusal({{"channels", Value::scalar("R")}}),
              Says("no mistake of the suite: the program wrote an unusable file",
                   "correct the program and delete the file"));
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

// By the same seed and under the same name; what was half written is gone.
TEST_F(Commands, ThatFailAreStartedAgain) {
  write_program(
      "test -e tried.$1.$2 || { touch tried.$1.$2; echo half >$3; echo bad luck >&2; exit 3; }; "
      "echo \"$1 $2\" >$3");
  const std::vector<Value::Member> once{as_text, {"retries", Value::scalar("1")}};
  static std::vector<std::string> said;
  static std::mutex saying;
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

TEST_F(Commands, ThatMakeSomeFilesAreStartedAgainForTheOthers) {
  several_ = true;
  write_program("echo $1 >>asked; echo ${1%%,*} >$3/${1%%,*}.txt");
  const draws::Prepared plugin = prepare({as_text, {"retries", Value::scalar("2")}});
  const auto worker = plugin.setup->make();
  worker->announce({.key = plugin.key, .first = 0, .last = 3});
  std::string wanted = bytes_in(file("asked"));
  for (std::uint64_t i = 0; i < 3; ++i) {
    expect_seed(plugin, *worker, i);
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
  for (std::uint64_t i = 0; i < 8; ++i) expect_seed(plugin, *worker, i);
  EXPECT_EQ(starts(), 1U + 8);  // the first to learn the size
}

TEST_F(Commands, NeedAPlaceForSamplesToTakeOtherThanOne) {
  std::ofstream(file("render.sh")) << "echo 1 >$2\n";
  const draws::Prepared plugin = prepare_command({"sh", "render.sh", "{seed}", "{out}"}, {as_text});
  EXPECT_EQ(draws::observe(plugin, 1)[0].values[0], 1);
  EXPECT_THAT(thrown([&] { draws::observe(plugin, 1, 4); }), HasSubstr("lacks `{samples}`"));
}

TEST_F(Commands, NeedPlacesForSeedAndFile) {
  for (const auto& [words, why] : std::map<std::vector<std::string>, const char*>{
           {{"render", "{out}"}, "lacks `{seed}`"},
           {{"render", "{seed}"}, "lacks `{out}`"},
           {{"render", "{seed}", "{seeds}", "{out}"}, "use one of them"},
           {{"render", "{seed}", "{sample}", "{out}"}, "did you mean `{samples}`?"},
           {{"no_such_program_anywhere", "{seed}", "{out}"},
            "written `./no_such_program_anywhere`"},
           {{"render {seed} {out}"}, "between the words: `[render, {seed}, {out}]`"}}) {
    EXPECT_THAT(thrown([&] { prepare_command(words, {}); }), HasSubstr(why));
  }
}

}  // namespace
}  // namespace assay
