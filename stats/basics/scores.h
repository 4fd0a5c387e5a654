#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace assay::stats {

// Ranks and standard scores.

// A value and its place among others.
template <class Real>
struct Placed {
  Real value;
  std::size_t place;
};

// Midranks from 0 on: equal values share the mean of their places. `order` is room for the order.
template <class Real>
void midranks(std::span<const Real> values, std::vector<Placed<Real>>& order,
              std::vector<double>& ranks);

// The ranks of the values, less their mean. Equal values are ranked in an order drawn by their
// places.
std::vector<double> centred_ranks(std::span<const double> values);

// Shifts and scales values to mean 0 and mean square 1. Values that are all equal become 0, and the
// result is false.
bool standardise(std::span<double> values);

}  // namespace assay::stats
