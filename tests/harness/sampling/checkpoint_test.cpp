#include "harness/sampling/checkpoint.h"

#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

class Kill : public std::runtime_error {
 public:
  Kill() : std::runtime_error("killed") {}
};

/// Dies after so many blocks, of which it tells how many are left.
class Mortal final : public Executor {
 public:
  Mortal(std::shared_ptr<Executor> inner, std::size_t blocks)
      : inner_(std::move(inner)), blocks_(blocks) {}
  std::size_t left() const { return blocks_; }
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

/// The run's record and how many blocks it drew, unless it dies after so many.
std::optional<std::pair<reports::Record, std::size_t>> drawn_by(std::shared_ptr<Executor> executor,
                                                                std::size_t blocks) {
  const auto mortal = std::make_shared<Mortal>(std::move(executor), blocks);
  try {
    reports::Record record = run_files({suite}, {.executor = mortal, .coarsen = 8});
    return std::pair(std::move(record), blocks - mortal->left());
  } catch (const Kill&) {
    return std::nullopt;
  }
}

// Killed after 5 blocks, then after twice as many, until the run ends.
TEST(Checkpoint, OfARunThatIsKilledGivesTheSameRecord) {
  const Workplace place;
  const auto whole = drawn_by(threads(1), 1'000'000);
  auto resumed = drawn_by(checkpoint(place.file("kept")), 5);
  std::size_t kills = 0;
  for (; !resumed; resumed = drawn_by(checkpoint(place.file("kept")), 5U << kills)) {
    std::ofstream(place.file("kept.kept"), std::ios::app) << "part of a writing";
    ++kills;
  }
  EXPECT_GT(kills, 1U);
  EXPECT_LT(resumed->second, whole->second);
  EXPECT_EQ(numbers_of(resumed->first), numbers_of(whole->first));
}

TEST(Checkpoint, WhoseKeptValuesAreDamagedIsRefused) {
  const Workplace place;
  const std::string file = place.file("kept");
  EXPECT_FALSE(drawn_by(checkpoint(file), 20));
  std::fstream(file + ".kept").seekp(100) << "damage";
  EXPECT_THAT(refusal([&] { drawn_by(checkpoint(file), 0); }), HasSubstr("its checksum differs"));
  std::filesystem::resize_file(file + ".kept", 50);
  EXPECT_THAT(refusal([&] { checkpoint(file); }), HasSubstr("says; remove both"));
}

TEST(Checkpoint, IsOfOneProcessAndCanBeWritten) {
  const Workplace place;
  const auto first = checkpoint(place.file("kept"));
  EXPECT_THAT(thrown<std::runtime_error>([&] { checkpoint(place.file("kept")); }),
              HasSubstr("another run is writing to"));
  std::filesystem::create_directory(place.file("other.kept"));
  EXPECT_THAT(thrown<std::runtime_error>([&] { checkpoint(place.file("other")); }),
              HasSubstr("cannot write"));
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
              HasSubstr("was not written by Assay; remove it"));
}

}  // namespace
}  // namespace assay::harness
