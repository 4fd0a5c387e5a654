#include "metropolis/coordinates.h"

#include <cmath>

namespace assay::metropolis {

double SmallStep::step(Stream& random) const {
  const double xi = 2 * random.uniform() - 1;
  const double length = largest * std::exp(-std::log(largest / smallest) * std::abs(xi));
  return xi < 0 ? -length : length;
}

std::optional<double> SmallStep::settled(double u) const {
  if (u >= 0 && u < 1) return u;
  if (boundary_ == Boundary::reject) return {};
  const bool wraps = boundary_ == Boundary::wrap;
  const double inside = wraps ? u - std::floor(u) : u < 0 ? -u : 2 - u;
  // Rounding may have led to 1 itself, which is 0 of the next round.
  return inside < 1 ? inside : wraps ? 0 : std::nextafter(1.0, 0.0);
}

void LazyCoordinates::restart() {
  list_.clear();
  saved_.clear();
  time_ = large_time_ = 1;
}

void LazyCoordinates::propose(bool large, Stream& random) {
  random_ = &random;
  large_ = large;
  inside_ = true;
  used_ = 0;
  saved_.clear();
}

double LazyCoordinates::uniform() {
  const std::size_t index = used_++;
  if (index == list_.size()) list_.emplace_back();
  Coordinate& coordinate = list_[index];
  if (large_) {
    set_aside(index);
    coordinate = {random_->uniform(), time_ + 1};
    return coordinate.value;
  }
  catch_up(coordinate);
  set_aside(index);
  const std::optional<double> moved = step_->moved(coordinate.value, *random_);
  // A proposal that has left is rejected whatever it brings; it goes on from inside.
  inside_ = inside_ && moved;
  coordinate = {moved.value_or(coordinate.value), time_ + 1};
  return coordinate.value;
}

void LazyCoordinates::accept() {
  if (large_) date_large_step();
  ++time_;
}

void LazyCoordinates::reject() {
  for (const Saved& saved : saved_) restore(saved);
}

void LazyCoordinates::catch_up(Coordinate& coordinate) {
  freshen(coordinate);
  // No path looks at a small step that was missed, so that the coordinate may stay where the step
  // would leave: that, too, is symmetric.
  for (; coordinate.time < time_; ++coordinate.time) {
    coordinate.value = step_->moved(coordinate.value, *random_).value_or(coordinate.value);
  }
}

void LazyCoordinates::freshen(Coordinate& coordinate) {
  if (coordinate.time < large_time_) coordinate = {random_->uniform(), large_time_};
}

}  // namespace assay::metropolis
