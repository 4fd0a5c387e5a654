#include "metropolis/coordinates.h"

#include <cmath>

namespace assay::metropolis {

namespace {

/// 1 itself, where rounding may have led, is 0 of the next round.
double wrapped(double u) {
  const double fraction = u - std::floor(u);
  return fraction < 1 ? fraction : 0;
}

double reflected(double u) {
  const double inside = u < 0 ? -u : u >= 1 ? 2 - u : u;
  return inside < 1 ? inside : std::nextafter(1.0, 0.0);
}

}  // namespace

double SmallStep::step(Stream& random) const {
  const double xi = 2 * random.uniform() - 1;
  const double length = largest * std::exp(-std::log(largest / smallest) * std::abs(xi));
  return xi < 0 ? -length : length;
}

std::optional<double> SmallStep::settled(double u) const {
  if (u >= 0 && u < 1) return u;
  if (boundary_ == Boundary::wrap) return wrapped(u);
  if (boundary_ == Boundary::reflect) return reflected(u);
  return {};
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
