#include "harness/sampling/checkpoint.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

class Kill : public std::runtime_error {
 public:
  Kill() : std::runtime_error("killed") {}
};

/// Dies after so many blocks.
class Mortal final : public Executor {
 public:
  Mortal(std::shared_ptr<Executor> inner, std::size_t blocks)
      : inner_(std::move(inner)), blocks_(blocks) {}
  void introduce(const NamedSetups& setups) override { inner_->introduce(setups); }
  void recall(const SomePools& pools) override { inner_->recall(pools); }
  void draw(Round& round) override {
    round.after_fold([this] {
      if (blocks_-- == 0) throw Kill();
    });
    inner_->draw(round);
  }

 private:
  std::shared_ptr<Executor> inner_;
  std::size_t blocks_;
};

std::shared_ptr<Checkpoint> checkpoint(const std::string& file, const Identity& identity = {}) {
  return std::make_shared<Checkpoint>(file, std::chrono::seconds(0), identity, threads(2));
}

const std::string suite = ASSAY_SOURCE_DIR "/tests/suites/kinds.yaml";

// Killed after 5 blocks, then after twice as many, until the run ends.
TEST(Checkpoint, OfARunThatIsKilledGivesTheSameRecord) {
  const Workplace place;
  const auto run_once = [&](std::size_t blocks) -> std::optional<reports::Record> {
    // A kill may leave part of a writing.
    std::ofstream(place.file("kept.kept"), std::ios::app) << "torn";
    try {
      const auto mortal = std::make_shared<Mortal>(checkpoint(place.file("kept")), blocks);
      return run_files({suite}, {.threads = 2, .executor = mortal, .coarsen = 8});
    } catch (const Kill&) {
      return std::nullopt;
    }
  };
  std::size_t kills = 0;
  std::optional<reports::Record> resumed;
  while (!(resumed = run_once(5U << kills))) ++kills;
  EXPECT_GT(kills, 1U);
  EXPECT_EQ(numbers_of(*resumed), numbers_of(run_files({suite}, {.threads = 1, .coarsen = 8})));
}

TEST(Checkpoint, WhoseKeptValuesAreDamagedIsRefused) {
  const Workplace place;
  const auto run_on = [&](std::size_t blocks) {
    run_files({suite},
              {.executor = std::make_shared<Mortal>(checkpoint(place.file("kept")), blocks),
               .coarsen = 8});
  };
  EXPECT_THROW(run_on(20), Kill);
  std::fstream(place.file("kept.kept")).seekp(100) << "damage";
  EXPECT_THAT(refusal([&] { run_on(0); }), HasSubstr("kept: it is damaged: its checksum differs"));
  std::filesystem::resize_file(place.file("kept.kept"), 50);
  EXPECT_THAT(refusal([&] { run_on(0); }), HasSubstr("kept: it is nothing that Assay packed"));
}

TEST(Checkpoint, OfAnotherRunIsRefusedWithTheDifference) {
  const Workplace place;
  checkpoint(place.file("kept"), {{"the seed", "1"}, {"the shard", "1/2"}});
  EXPECT_EQ(refusal([&] {
              checkpoint(place.file("kept"), {{"the seed", "1"}, {"the shard", "2/2"}});
            }),
            "is the checkpoint of another run: the shard was 1/2 and is 2/2; remove it, or name "
            "another file");
}

TEST(Checkpoint, ThatIsNoneOrCutShortIsRefused) {
  const Workplace place;
  checkpoint(place.file("kept"));
  std::filesystem::resize_file(place.file("kept"), 30);
  EXPECT_THAT(refusal([&] { checkpoint(place.file("kept")); }), HasSubstr("cut short"));
  EXPECT_THAT(refusal([&] { checkpoint(place.write("text", "hello")); }),
              HasSubstr("is nothing that Assay packed; remove it"));
}

}  // namespace
}  // namespace assay::harness
