#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "estimators/stream.h"

namespace assay {

/// The first two words of a stream, read as a Stream reads them. There is no third: who draws more
/// takes the Stream.
class FirstWords {
 public:
  FirstWords() = default;
  FirstWords(std::uint64_t first, std::uint64_t second) : words_{first, second} {}

  std::uint64_t operator()() { return words_[next_++ & 1]; }
  double uniform() { return word::uniform((*this)()); }
  double uniform_open() { return word::uniform_open((*this)()); }

 private:
  std::array<std::uint64_t, 2> words_{};
  std::uint32_t next_ = 0;
};

/// The first words of the streams of consecutive observations of one key, from `first` on. They are
/// those of Stream(key, first + i), bit by bit. Eight streams side by side take a quarter of the
/// time.
void first_words(StreamKey key, std::uint64_t first, std::span<FirstWords> words);

}  // namespace assay
