#include "harness/sampling/packing.h"

#include <rapidcheck/gtest.h>

#include "harness/sampling/executor.h"
#include "tests/prelude.h"

namespace assay::harness {
namespace {

constexpr std::size_t channel_count = 3;
const std::string nothing = thrown([] {});

/// Two sums, which may be an image, and the number of a cell. One observation may be no number, and
/// one may throw.
std::shared_ptr<const Setup> odd(std::optional<std::uint64_t> throws = {}, bool image = false) {
  SetupParts parts{.channels = std::vector<Channel>(image ? 1 : 3)};
  if (image) parts.image = ImageShape{.width = 2, .height = 1};
  parts.make = estimating(
      [throws](Stream& random, std::uint64_t primaries, std::span<double> out, Cost& cost) {
        if (random.observation() == throws) throw std::runtime_error("the lamp burnt out");
        out[0] = random.uniform() + static_cast<double>(primaries);
        out[1] = random.observation() == 3 ? std::numeric_limits<double>::infinity() : -out[0];
        out[2] = static_cast<double>(random() % 5);
        cost.samples += primaries;
        cost.shadow_rays += random() % 3;
      });
  return setup_of(std::move(parts));
}

Recipe some_recipe() {
  Recipe recipe{.key = {*rc::gen::arbitrary<std::uint64_t>()},
                .primaries = *rc::gen::inRange<std::uint64_t>(1, 5000)};
  if (*rc::gen::arbitrary<bool>()) {
    for (std::size_t c = 0; c < channel_count; ++c) {
      recipe.plan.push_back(
          {.histogram_low = 0,
           .histogram_high = *rc::gen::element(0.0, 2.0, 9.0),
           .keep = *rc::gen::element<std::uint64_t>(0, 1, 20, 100000),
           .powers = *rc::gen::element(Powers::none, Powers::of_values, Powers::with_costs)});
    }
    recipe.plan[2].cells = *rc::gen::element<std::size_t>(0, 5);
  }
  if (*rc::gen::arbitrary<bool>()) recipe.grouped_channels = {0, 1};
  recipe.kept_observations = *rc::gen::element<std::uint64_t>(0, 1, 50, 200);
  recipe.marks =
      *rc::gen::unique<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(1, 200));
  recipe.marks.push_back(200);
  std::ranges::sort(recipe.marks);
  return recipe;
}

std::shared_ptr<Pool> fresh(const Recipe& recipe, const std::shared_ptr<const Setup>& setup) {
  return std::make_shared<Pool>(setup, recipe);
}

void draw_all_of(const std::shared_ptr<Pool>& pool) {
  pool->request(200);
  draw_all({pool}, *threads(1), "sampling", silence);
}

std::string drawn_of(const Pool& pool) {
  return packed(pool.kept_block(0, pool.drawn()), pool.drawn_sums());
}

Pool::Block unpacked(std::string_view frame) {
  Pool::Block block;
  unpack(frame, block);
  return block;
}

/// All that is drawn, without the seconds.
std::string contents_of(const Pool& pool) {
  Pool::Block sums = unpacked(packed(pool.drawn_sums()));
  sums.whole.seconds = 0;
  for (auto& [count, each] : sums.partial) std::const_pointer_cast<Summary>(each)->seconds = 0;
  return packed(pool.kept_block(0, pool.drawn()), sums);
}

/// Draws the blocks in another process's way: by an unpacked recipe, and packed.
std::vector<std::string> blocks_elsewhere(const Recipe& recipe, std::shared_ptr<const Setup> of) {
  Recipe there;
  unpack(packed(recipe), there);
  const std::shared_ptr<Pool> pool = fresh(there, std::move(of));
  const SomePools pools{pool};
  const DrawBlock draw = drawing_of(pools);
  std::vector<std::string> blocks;
  for (std::uint64_t first = 0; first < 200; first = pool->block_end(first)) {
    const Task task{.pool = 0, .first = first, .last = pool->block_end(first)};
    blocks.push_back(packed(draw(task)));
  }
  return blocks;
}

RC_GTEST_PROP(Packing, GivesThePoolThatIsDrawnHere, ()) {
  const auto setup = odd(*rc::gen::element<std::optional<std::uint64_t>>({}, 0, 10, 150),
                         *rc::gen::arbitrary<bool>());
  const Recipe recipe = some_recipe();
  const std::shared_ptr<Pool> here = fresh(recipe, setup);
  draw_all_of(here);
  const std::shared_ptr<Pool> folded = fresh(recipe, setup);
  for (const std::string& block : blocks_elsewhere(recipe, setup)) {
    if (folded->fault()) break;
    folded->fold(unpacked(block));
  }
  RC_ASSERT(contents_of(*folded) == contents_of(*here));
  RC_ASSERT(folded->fault().has_value() == here->fault().has_value());
  // Kept values come in parts, too.
  const std::shared_ptr<Pool> again = fresh(recipe, setup);
  Pool::Block all = unpacked(packed(here->drawn_sums()));
  for (std::uint64_t i = 0; i <= here->kept_end(); i += 30) {
    all.append_kept(unpacked(packed(here->kept_block(i, i + 30))));
  }
  again->fold(std::move(all));
  RC_ASSERT(drawn_of(*again) == drawn_of(*here));
}

bool is_refused(const std::string& frame) {
  return thrown<Unpackable>([&] { unpacked(frame); }) != nothing;
}

RC_GTEST_PROP(Packing, RefusesWhatIsCutShortOrDamaged, ()) {
  const Recipe recipe = some_recipe();
  const std::string frame = blocks_elsewhere(recipe, odd()).front();
  RC_ASSERT(!is_refused(frame));
  RC_ASSERT(is_refused(frame.substr(0, *rc::gen::inRange<std::size_t>(0, frame.size()))));
  std::string flipped = frame;
  char& byte = flipped[*rc::gen::inRange<std::size_t>(0, frame.size())];
  byte = static_cast<char>(byte ^ (1 << *rc::gen::inRange(0, 8)));
  RC_ASSERT(is_refused(flipped));
  RC_ASSERT(is_refused(frame + "x"));
}

/// Changes some bytes; tells the first.
std::size_t damage(std::string& bytes) {
  const std::size_t at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  const std::size_t end = std::min(at + 8, bytes.size());
  for (std::size_t i = at; i < end; ++i) bytes[i] = *rc::gen::arbitrary<char>();
  return at;
}

// A damage that the checksum does not show: each list is still bounded.
RC_GTEST_PROP(Packing, OfDamagedBytesUnderARightChecksumDoesNotCrash, ()) {
  const Recipe recipe = some_recipe();
  std::string bytes(unframed(blocks_elsewhere(recipe, odd()).front()));
  const std::size_t at = damage(bytes);
  for (const std::string& frame : {framed(bytes), framed(bytes.substr(0, at))}) {
    // Anything else that is thrown fails the property.
    thrown<Unpackable>([&] { unpacked(frame); });
  }
}

std::string refusal_of(std::string frame, std::size_t at, char byte) {
  frame[at] = byte;
  return thrown<Unpackable>([&] { unframed(frame); });
}

TEST(Packing, NamesAnotherVersion) {
  const std::string frame = packed(std::uint64_t{7});
  EXPECT_EQ(refusal_of(frame, 0, 'a'), nothing);
  EXPECT_EQ(refusal_of(frame, 0, 'b'), "it was not written by Assay");
  EXPECT_EQ(refusal_of(frame, 6, '0'), "it is of another version of Assay");
  EXPECT_EQ(refusal_of(frame, 8, 8), "it is cut short or damaged: its checksum differs");
}

TEST(Packing, KeepsTheBitsOfEachDouble) {
  const std::vector<double> odd{-0.0, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::denorm_min(), 0.1};
  std::vector<double> again;
  unpack(packed(odd), again);
  ASSERT_EQ(again.size(), odd.size());
  EXPECT_EQ(std::memcmp(again.data(), odd.data(), odd.size() * sizeof(double)), 0);
}

// 2^60 numbers in 16 bytes.
TEST(Packing, AllocatesNothingForALengthThatIsNotThere) {
  std::vector<double> list;
  EXPECT_THROW(unpack(packed(std::uint64_t{1} << 60, 1.0), list), Unpackable);
}

}  // namespace
}  // namespace assay::harness
