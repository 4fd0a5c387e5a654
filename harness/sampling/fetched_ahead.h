#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <span>
#include <vector>

#include "estimators/estimator.h"

namespace assay::harness {

/// Results for announced observations, fetched many at a time: a sampler in another program takes
/// longer to be asked than to answer.
template <class Row>
class FetchedAhead {
 public:
  void announce(const Announcement& next) { announced_ = next; }

  /// The row of an observation. `fetch` gets streams and makes the rows of the first few, at least
  /// one. If it throws for several, each is fetched alone, and the one at fault throws again.
  template <class Fetch>
  const Row& of(const Stream& random, Fetch fetch) {
    if (!holds(random)) {
      rows_.clear();
      std::vector<Stream> streams = streams_from(random);
      try {
        rows_ = fetch(std::span(streams));
      } catch (const std::exception&) {
        if (streams.size() == 1) throw;
        announced_ = {};
        rows_ = fetch(std::span(streams).first(1));
      }
      key_ = random.key();
      first_ = random.observation();
    }
    return rows_[random.observation() - first_];
  }

 private:
  static constexpr std::uint64_t most = 4096;

  bool holds(const Stream& random) const {
    return random.key() == key_ && random.observation() >= first_ &&
           random.observation() - first_ < rows_.size();
  }

  std::vector<Stream> streams_from(const Stream& random) const {
    const std::uint64_t first = random.observation();
    const std::uint64_t end = std::min(announced_.end_from(random.key(), first), first + most);
    std::vector<Stream> streams;
    for (std::uint64_t i = first; i < end; ++i) streams.emplace_back(random.key(), i);
    return streams;
  }

  Announcement announced_{};
  StreamKey key_{};
  std::uint64_t first_ = 0;
  std::vector<Row> rows_;
};

}  // namespace assay::harness
