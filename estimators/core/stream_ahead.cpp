#include "estimators/core/philox_lanes.h"
#include "estimators/stream.h"

namespace assay {

void Stream::draw_all() {
  static_assert(most_words == 2 * PhiloxLanes::together);
  PhiloxLanes draws = PhiloxLanes::draws_from(counter_);
  draws.encipher(key_);
  draws.words([this](std::size_t draw, std::uint64_t one, std::uint64_t two) {
    words_[2 * draw] = one;
    words_[2 * draw + 1] = two;
  });
  counter_[0] += PhiloxLanes::together;
  next_ = 0;
}

}  // namespace assay
