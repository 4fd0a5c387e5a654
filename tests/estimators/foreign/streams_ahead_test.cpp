#include "estimators/foreign/shared_library.h"
#include "tests/prelude.h"

namespace assay::foreign {
namespace {

// Before, across and after what was announced, forwards and back; of another key too.
TEST(StreamsAhead, GiveTheNumbersOfTheStreams) {
  const StreamKey announced{77};
  StreamsAhead streams;
  streams.announce({.key = announced, .first = 100, .last = 800});
  for (const StreamKey key : {announced, StreamKey{78}}) {
    for (const std::uint64_t index : {99U, 100U, 355U, 356U, 611U, 799U, 800U, 500U, 0U}) {
      AssayStream ahead = streams.of(key, index);
      AssayStream plain = assay_stream(key.bits, index);
      AssayStream split_ahead = assay_substream(&ahead, 4);
      AssayStream split_plain = assay_substream(&plain, 4);
      for (int word = 0; word < 5; ++word) {
        EXPECT_EQ(assay_word(&ahead), assay_word(&plain)) << index << ", word " << word;
        EXPECT_EQ(assay_word(&split_ahead), assay_word(&split_plain)) << index;
      }
    }
  }
}

}  // namespace
}  // namespace assay::foreign
