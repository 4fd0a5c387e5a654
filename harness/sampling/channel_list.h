#pragma once

#include <cstddef>
#include <ranges>
#include <utility>
#include <vector>

namespace assay::harness {

/// Places of channels among those of an estimator: of some, or of an image's elements at even
/// steps.
class ChannelList {
 public:
  ChannelList() = default;
  ChannelList(std::vector<std::size_t> places)
      : places_(std::move(places)), size_(places_.size()) {}
  /// first, first + step, …
  ChannelList(std::size_t first, std::size_t step, std::size_t size)
      : first_(first), step_(step), size_(size) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t operator[](std::size_t i) const {
    return places_.empty() ? first_ + i * step_ : places_[i];
  }
  auto all() const {
    return std::views::iota(std::size_t{0}, size_) |
           std::views::transform([this](std::size_t i) { return (*this)[i]; });
  }

 private:
  std::vector<std::size_t> places_;
  std::size_t first_ = 0;
  std::size_t step_ = 1;
  std::size_t size_ = 0;
};

}  // namespace assay::harness
