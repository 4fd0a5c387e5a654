#include "metropolis/lazy_coordinates.h"

namespace assay::metropolis {

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
  while (coordinate.time < time_) advance(coordinate);
}

void LazyCoordinates::freshen(Coordinate& coordinate) {
  if (coordinate.time < large_time_) coordinate = {random_->uniform(), large_time_};
}

void LazyCoordinates::advance(Coordinate& coordinate) {
  coordinate.value = step_->moved(coordinate.value, *random_).value_or(coordinate.value);
  ++coordinate.time;
}

}  // namespace assay::metropolis
