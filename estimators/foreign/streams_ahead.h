#pragma once

#include <array>
#include <cstdint>

#include "estimators/estimator.h"
#include "estimators/first_words.h"
#include "estimators/plugin_abi.h"

namespace assay::foreign {

/// Streams as a library has them. Those of announced observations come with their first block of
/// random words, which is drawn for many at a time: four times as fast as by the library itself.
class StreamsAhead {
 public:
  void announce(const Announcement& next);

  /// The same numbers as those of assay_stream(key, observation), announced or not.
  AssayStream of(StreamKey key, std::uint64_t observation);

 private:
  static constexpr std::uint64_t batch = 256;

  Announcement announced_{};
  std::uint64_t first_ = 0;  // of those in `words_`
  std::uint64_t last_ = 0;
  std::array<FirstWords, batch> words_{};
};

}  // namespace assay::foreign
