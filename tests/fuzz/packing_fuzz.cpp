// Blocks of other processes (harness/sampling/packing.h). All bytes are unpacked or refused. A
// block that was unpacked is packed and read again as the same.

#include "harness/sampling/packing.h"
#include "tests/fuzz/case.h"

namespace {

using namespace assay::harness;
using assay::fuzz::require;

Pool::Block unpacked(std::string_view frame) {
  Pool::Block block;
  unpack(frame, block);
  return block;
}

}  // namespace

/// The bytes are a frame, or a block.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = assay::fuzz::text_of(data, size);
  try {
    require(framed(unframed(bytes)) == bytes);
  } catch (const Unpackable&) {
  }
  try {
    const std::string frame = packed(unpacked(framed(bytes)));
    require(packed(unpacked(frame)) == frame);
  } catch (const Unpackable&) {
  }
  return 0;
}
