#pragma once

// The coordinates of a chain's state, mutated on demand. Source: Kelemen, Szirmay-Kalos, Antal and
// Csonka 2002, "A simple and robust mutation strategy for the Metropolis light transport
// algorithm", section 3.3.

#include <cstdint>
#include <memory>
#include <vector>

#include "metropolis/coordinates.h"
#include "metropolis/small_step.h"

namespace assay::metropolis {

/// Every accepted proposal moves all coordinates, but a path looks at a few. Each value carries its
/// time, counted in accepted proposals. The next look makes up for the missed ones: a fresh value
/// for a large step, then a small step for each small one. A proposal sets a coordinate aside
/// before it changes it. A rejection puts it back.
class LazyCoordinates : public Coordinates {
 public:
  explicit LazyCoordinates(std::shared_ptr<const SmallStep> step) : step_(std::move(step)) {}

  /// Forgets everything: a state of fresh uniform coordinates.
  void restart();
  /// Begins a proposal from the state: all coordinates fresh (`large`), or each a small step away.
  /// It takes numbers from `random` until the next proposal.
  void propose(bool large, Stream& random);
  double uniform() override;
  /// True if no coordinate of the proposal has left [0, 1).
  bool inside() const { return inside_; }
  /// Makes the proposal the state.
  void accept();
  /// Goes back to the state that the proposal began from.
  virtual void reject();

 protected:
  struct Coordinate {
    double value = 0;
    std::uint64_t time = 0;  ///< the state that the value is of; 0: none yet
  };
  struct Saved {
    std::size_t index;
    Coordinate coordinate;
  };

  /// Keeps what a coordinate of the state is before the proposal changes it.
  virtual void set_aside(std::size_t index) { saved_.push_back({index, list_[index]}); }
  /// Brings a coordinate to the time of the state.
  virtual void catch_up(Coordinate& coordinate);

  /// Draws a coordinate afresh that has not been looked at since the last large step.
  void freshen(Coordinate& coordinate);
  /// A small step that a coordinate has missed. No path looks at it, so that it may stay where the
  /// step would leave: that, too, is symmetric.
  void advance(Coordinate& coordinate);
  bool large() const { return large_; }
  std::uint64_t time() const { return time_; }
  /// From the proposal on, coordinates that are older are drawn afresh.
  void date_large_step() { large_time_ = time_ + 1; }

  const std::vector<Saved>& saved() const { return saved_; }
  void restore(const Saved& saved) { list_[saved.index] = saved.coordinate; }

 private:
  std::shared_ptr<const SmallStep> step_;
  std::vector<Coordinate> list_;
  std::vector<Saved> saved_;
  Stream* random_ = nullptr;
  std::size_t used_ = 0;
  std::uint64_t time_ = 1;        ///< of the state
  std::uint64_t large_time_ = 1;  ///< of the last accepted large step
  bool large_ = false;
  bool inside_ = true;
};

}  // namespace assay::metropolis
