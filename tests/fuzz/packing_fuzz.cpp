// Blocks and recipes of other processes (harness/sampling/packing.h). All bytes are unpacked or
// refused. A block that was unpacked can be folded, and is packed and read again as the same.

#include "harness/sampling/packing.h"
#include "tests/fuzz/case.h"

namespace {

using namespace assay;
using namespace assay::harness;
using assay::fuzz::require;

/// Nothing is drawn of it. The first two may be an image.
std::shared_ptr<const Setup> three_sums(bool image) {
  SetupParts parts{.channels = std::vector<Channel>(image ? 1 : 3)};
  if (image) parts.image = ImageShape{.width = 2, .height = 1};
  return setup_of(std::move(parts));
}

// Large enough to matter; small enough not to test the memory alone.
bool is_modest(const Recipe& recipe) {
  for (const ChannelPlan& channel : recipe.plan) {
    if (channel.cells > 1024) return false;
  }
  return true;
}

void block(std::string_view bytes, const Recipe& recipe, bool image) try {
  Pool pool = pool_of(recipe, three_sums(image));
  const std::string packed = packed_block(unpacked_block(bytes, pool, 0));
  const Pool::Block again = unpacked_block(packed, pool, 0);
  require(packed_block(again) == packed);
  pool.fold(unpacked_block(packed, pool, 0));
  require(pool.drawn() == again.whole.count);
} catch (const Unpackable&) {
}

}  // namespace

/// The bytes are a frame, or a recipe and a block.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = assay::fuzz::text_of(data, size);
  try {
    require(framed(unframed(bytes)) == bytes);
  } catch (const Unpackable&) {
  }
  try {
    Unpacker unpack(bytes);
    Recipe recipe;
    std::string_view rest;
    unpack(recipe, rest);
    unpack.end();
    if (!is_modest(recipe)) return 0;
    for (const bool image : {false, true}) block(rest, recipe, image);
  } catch (const Unpackable&) {
  }
  return 0;
}
