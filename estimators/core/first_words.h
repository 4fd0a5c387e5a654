#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "estimators/estimator.h"
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

/// The first random words of announced observations, drawn for a batch of them at a time: four
/// times as fast as one by one.
class AnnouncedWords {
 public:
  static constexpr std::uint64_t batch = 256;

  void announce(const Announcement& next) {
    announced_ = next;
    first_ = last_ = next.first;
  }

  bool has(StreamKey key, std::uint64_t observation) const {
    return key == announced_.key && observation >= announced_.first &&
           observation < announced_.last;
  }

  /// Draws the batch that an announced observation begins; false where it stands in the last one.
  bool reach(std::uint64_t observation) {
    if (observation >= first_ && observation < last_) return false;
    first_ = observation;
    last_ = std::min(first_ + batch, announced_.last);
    first_words(announced_.key, first_, words());
    return true;
  }

  /// The batch, and the place of an observation in it.
  std::span<FirstWords> words() { return std::span(words_).first(last_ - first_); }
  std::size_t place(std::uint64_t observation) const { return observation - first_; }

 private:
  Announcement announced_{};
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;
  std::array<FirstWords, batch> words_{};
};

}  // namespace assay
