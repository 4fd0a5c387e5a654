#include "harness/sampling/checkpoint.h"

#include "tests/harness/refusal.h"
#include "tests/harness/running.h"
#include "tests/prelude.h"

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

/// Runs a suite that is killed after so many blocks, then after twice as many, until it ends.
struct Resumed {
  reports::Record record;
  std::size_t kills = 0;
};
Resumed resumed(const std::string& suite, const Workplace& place, std::size_t blocks) {
  for (std::size_t kills = 0;; ++kills) {
    try {
      const auto mortal = std::make_shared<Mortal>(checkpoint(place.file("kept")), blocks << kills);
      return {run_files({suite}, {.threads = 2, .executor = mortal, .coarsen = 8}), kills};
    } catch (const Kill&) {
    }
  }
}

class Checkpoints : public testing::TestWithParam<const char*> {};

// Pools of averages, spreads, laws, cells, images, slopes and samplers.
TEST_P(Checkpoints, OfARunThatIsKilledGiveTheSameRecord) {
  const std::string suite = std::string(ASSAY_SOURCE_DIR "/suites/") + GetParam();
  const std::string whole = numbers_of(run_files({suite}, {.threads = 1, .coarsen = 8}));
  const Workplace place;
  const Resumed run = resumed(suite, place, 5);
  EXPECT_EQ(numbers_of(run.record), whole) << run.kills << " kills";
  EXPECT_GT(run.kills, 1U);
}

INSTANTIATE_TEST_SUITE_P(Suites, Checkpoints,
                         testing::Values("luminaire.yaml", "analytic.yaml", "images.yaml"));

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
