#pragma once

#include <cstdint>

#include "estimators/core/announced_words.h"
#include "estimators/plugin_abi.h"

namespace assay::foreign {

/// Streams as a library has them; those of announced observations come with their first block of
/// random words.
class StreamsAhead {
 public:
  void announce(const Announcement& next) { ahead_.announce(next); }

  /// The same numbers as those of assay_stream(key, observation), announced or not.
  AssayStream of(StreamKey key, std::uint64_t observation);

 private:
  AnnouncedWords ahead_;
};

}  // namespace assay::foreign
