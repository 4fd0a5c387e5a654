#include "estimators/core/first_words.h"

#include "estimators/core/philox_lanes.h"

namespace assay {
namespace {

/// Draw 0, substream 0 of observations `first` on.
PhiloxLanes streams_from(std::uint64_t first) {
  PhiloxLanes all;
  for (std::size_t r = 0; r < PhiloxLanes::registers; ++r) {
    const std::uint64_t observation = first + PhiloxLanes::lanes * r;
    all.x0[r] = all.x1[r] = PhiloxLanes::everywhere(0);
    all.x2[r] = PhiloxLanes::Register{observation, observation + 1};
    all.x3[r] = all.x2[r] >> 32;
  }
  return all;
}

PhiloxKey halves_of(StreamKey key) {
  return {static_cast<std::uint32_t>(key.bits), static_cast<std::uint32_t>(key.bits >> 32)};
}

}  // namespace

void first_words(StreamKey key, std::uint64_t first, std::span<FirstWords> words) {
  std::size_t done = 0;
  for (; done + PhiloxLanes::together <= words.size(); done += PhiloxLanes::together) {
    PhiloxLanes streams = streams_from(first + done);
    streams.encipher(halves_of(key));
    streams.words([&](std::size_t stream, std::uint64_t one, std::uint64_t two) {
      words[done + stream] = {one, two};
    });
  }
  for (; done < words.size(); ++done) {
    Stream stream(key, first + done);
    const std::uint64_t one = stream();
    words[done] = {one, stream()};
  }
}

}  // namespace assay
