#include "estimators/foreign/streams_ahead.h"

#include <algorithm>
#include <span>

namespace assay::foreign {

void StreamsAhead::announce(const Announcement& next) {
  announced_ = next;
  first_ = last_ = next.first;
}

AssayStream StreamsAhead::of(StreamKey key, std::uint64_t observation) {
  AssayStream stream = assay_stream(key.bits, observation);
  if (key != announced_.key || observation < announced_.first || observation >= announced_.last) {
    return stream;
  }
  if (observation < first_ || observation >= last_) {
    first_ = observation;
    last_ = std::min(first_ + batch, announced_.last);
    first_words(key, first_, std::span(words_).first(last_ - first_));
  }
  // As assay_refill() leaves it.
  FirstWords words = words_[observation - first_];
  stream.words[0] = words();
  stream.words[1] = words();
  stream.counter[0] = 1;
  stream.next = 0;
  return stream;
}

}  // namespace assay::foreign
