#include "estimators/foreign/streams_ahead.h"

namespace assay::foreign {

AssayStream StreamsAhead::of(StreamKey key, std::uint64_t observation) {
  AssayStream stream = assay_stream(key.bits, observation);
  if (!ahead_.has(key, observation)) return stream;
  ahead_.reach(observation);
  // The state that assay_refill() leaves.
  FirstWords words = ahead_.words()[ahead_.place(observation)];
  stream.words[0] = words();
  stream.words[1] = words();
  stream.counter[0] = 1;
  stream.next = 0;
  return stream;
}

}  // namespace assay::foreign
