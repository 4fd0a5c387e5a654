#pragma once

// The numbers that a path is made of, asked for one after the other, and mutated on demand by
// chains. Source: Kelemen, Szirmay-Kalos, Antal and Csonka 2002, "A simple and robust mutation
// strategy for the Metropolis light transport algorithm", section 3.3.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "estimators/stream.h"

namespace assay::metropolis {

/// A point of the primary sample space [0, 1)^infinity whose coordinates come into being when they
/// are asked for. It stands where a path tracer has its source of random numbers.
class Coordinates {
 public:
  virtual ~Coordinates() = default;
  virtual double uniform() = 0;
};

/// Independent uniform coordinates: plain Monte Carlo.
class IndependentCoordinates final : public Coordinates {
 public:
  explicit IndependentCoordinates(Stream& random) : random_(random) {}
  double uniform() override { return random_.uniform(); }

 private:
  Stream& random_;
};

/// The fate of a coordinate that steps out of [0, 1). All three keep uniform coordinates uniform
/// and are symmetric: the density to go from u to v is that to go from v to u.
enum class Boundary {
  wrap,     ///< comes in again at the other end
  reflect,  ///< is turned back at the end
  reject,   ///< the whole proposal is rejected
};

/// A step of random sign and of length largest (smallest / largest)^xi (Kelemen et al. 2002,
/// section 3.2). Its density is in proportion to 1 / length between `smallest` and `largest`.
class SmallStep {
 public:
  static constexpr double smallest = 1.0 / 1024;
  static constexpr double largest = 1.0 / 64;

  explicit SmallStep(Boundary boundary) : boundary_(boundary) {}
  virtual ~SmallStep() = default;

  /// The coordinate moved; nothing if the step leaves [0, 1) and is to be rejected.
  std::optional<double> moved(double u, Stream& random) const { return settled(u + step(random)); }
  /// The step with its sign, from one random number.
  virtual double step(Stream& random) const;
  /// The place in [0, 1) of a coordinate in (-1, 2); nullopt if the step is rejected.
  virtual std::optional<double> settled(double u) const;

 private:
  Boundary boundary_;
};

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
  /// From the proposal on, coordinates that are older are drawn afresh.
  void date_large_step() { large_time_ = time_ + 1; }

  void restore(const Saved& saved) { list_[saved.index] = saved.coordinate; }

  std::vector<Saved> saved_;
  std::uint64_t time_ = 1;  ///< of the state
  bool large_ = false;

 private:
  std::shared_ptr<const SmallStep> step_;
  std::vector<Coordinate> list_;
  Stream* random_ = nullptr;
  std::size_t used_ = 0;
  std::uint64_t large_time_ = 1;  ///< of the last accepted large step
  bool inside_ = true;
};

}  // namespace assay::metropolis
