#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "stats/basics/moments.h"

namespace assay::stats {

// Sums of the powers d^i e^j of pairs (x, cost) for i + 2 j <= 8. Here d = x - mean x and e = cost
// - mean cost. They hold the first four moments of any A d^2 + B d + C e (influence.h). Merging
// formulas: Pebay, SAND2008-6212, section 3, by moving both means. Both means keep what rounding
// takes from them. Values must be finite. A constant cost keeps every sum with e at exactly zero.
struct JointMoments {
  static constexpr std::size_t weight = 8;
  static constexpr std::size_t powers_of_cost = weight / 2;
  static constexpr std::size_t count_of_sums = 25;

  struct Coordinate {
    double mean = 0;
    double rest = 0;  // The true mean less `mean`.
    double minimum = std::numeric_limits<double>::infinity();
    double maximum = -std::numeric_limits<double>::infinity();

    friend bool operator==(const Coordinate&, const Coordinate&) = default;
  };

  std::uint64_t count = 0;
  std::size_t known = weight;  // Sums of a greater weight i + 2 j mean nothing.
  Coordinate of_x;
  Coordinate of_cost;
  std::array<double, count_of_sums> sums{};  // By place(i, j); the first is the count.

  // The index of the sum of d^i e^j.
  static constexpr std::size_t place(std::size_t i, std::size_t j) {
    return j * (weight + 2 - j) + i;
  }
  double sum(std::size_t i, std::size_t j) const { return sums[place(i, j)]; }

  // Same as taking the other sample's pairs here. Merging in a fixed order gives fixed bits.
  void merge(const JointMoments& other);

  // The moments of one coordinate; they count no zeros.
  Moments x() const;
  Moments cost() const;

  friend bool operator==(const JointMoments&, const JointMoments&) = default;
};

// True if a double holds the eighth powers of the spread, or of Moments the fourth: none overflows,
// and none has lost digits to underflow. Of fewer than two values it is true.
bool has_sound_powers(const JointMoments& powers);
bool has_sound_powers(const Moments& moments);

// The sums up to weight 4 that the moments of x tell, at a constant cost.
JointMoments joint_of_four(const Moments& x, double cost = 0);

// Takes pairs one by one into joint moments. Some hundred wait. Two passes sum them about their own
// mean, and one merge adds them: pairs far from zero lose nothing. The result depends on the order
// of pairs and parts alone.
class JointSums {
 public:
  JointSums() = default;
  // Goes on from known moments.
  explicit JointSums(const JointMoments& known) : summed_(known) {}

  void add(double value, double its_cost) {
    waiting_.push_back({value, its_cost});
    if (waiting_.size() == most_waiting) sum_waiting();
  }
  // Same as adding the other's pairs here.
  void merge(const JointSums& other);
  JointMoments moments() const;

  friend bool operator==(const JointSums&, const JointSums&) = default;

 private:
  struct Pair {
    double x;
    double cost;
    friend bool operator==(const Pair&, const Pair&) = default;
  };
  static constexpr std::size_t most_waiting = 256;

  void sum_waiting();
  JointMoments of_waiting() const;

  JointMoments summed_;
  std::vector<Pair> waiting_;
};

}  // namespace assay::stats
