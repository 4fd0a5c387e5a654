#include "stats/means/betting_mean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "stats/basics/check.h"
#include "stats/basics/scores.h"
#include "stats/basics/search.h"
#include "stats/basics/vector_copies.h"
#include "stats/tails/special.h"

namespace assay::stats {
namespace {

// Ranks from the nearer end to a value in a cell.
constexpr std::size_t ranks_a_value = 32;

constexpr double infinity = std::numeric_limits<double>::infinity();

// The gain of a bet that no null hypothesis survives.
constexpr double most_gain = 1e300;

constexpr std::array<double, bet_count> bets = [] {
  std::array<double, bet_count> each{1 - 0x1p-10, 0.875, 0.6875};
  double next = 1;
  for (std::size_t k = 3; k < bet_count; ++k) each[k] = next /= 2;
  return each;
}();

// Whole vectors of numbers: the last bet is nothing, and not counted.
using OfBets = std::array<double, bet_count + 1>;
constexpr OfBets bets_and_none = [] {
  OfBets all{};
  std::copy(bets.begin(), bets.end(), all.begin());
  return all;
}();

// The cell of values[begin, end), ascending.
ValueCells::Cell cell_of(std::span<const double> values) {
  ValueCells::Cell cell{.least = values.front(),
                        .largest = values.back(),
                        .count = static_cast<double>(values.size())};
  const double width = cell.largest - cell.least;
  if (width > 0) {
    for (const double value : values) cell.at_largest += (value - cell.least) / width;
  }
  return cell;
}

// The gain of a bet on a value, as a share of itself. Rounding may take a value past the range's
// end.
double gain(double value, double null, double room) {
  return std::clamp((value - null) / room, -1.0, most_gain);
}

// ln(1 + z) for z > -1, in steps that a compiler takes for several numbers at once. Let
// 1 + z = 2^e m with sqrt(1/2) <= m < sqrt 2. A series gives ln m = 2 artanh((m - 1) / (m + 1)).
inline double log1p_in_steps(double z) {
  constexpr std::uint64_t half_root = 0x3fe6a09e667f3bcd;  // sqrt(1/2)
  constexpr std::uint64_t bias = 1023;
  constexpr std::uint64_t of_2_to_52 = 0x4330000000000000;
  const double u = 1 + z;
  const auto bits = std::bit_cast<std::uint64_t>(u);
  const std::uint64_t exponent = (bits - half_root + (bias << 52)) >> 52;
  const double e = std::bit_cast<double>(exponent | of_2_to_52) - (0x1p52 + bias);
  const double m = std::bit_cast<double>(bits - (exponent << 52) + (bias << 52));
  const double s = (m - 1) / (m + 1);
  const double t = s * s;
  double series = 0;
  for (int k = 21; k >= 3; k -= 2) series = (series + 1.0 / k) * t;
  constexpr double ln2_high = 0x1.62e42fefa38p-1;  // 2046 times it is exact
  const double lost = (z - (u - 1)) / u;
  return e * ln2_high + (2 * s + (2 * s * series + (e * (std::numbers::ln2 - ln2_high) + lost)));
}

// Adds the logarithms of each bet's wealth after so many values of one gain.
ASSAY_VECTOR_COPIES void add_logs(double count, double gained, double* logs) {
  for (std::size_t k = 0; k < bets_and_none.size(); ++k) {
    logs[k] += count * log1p_in_steps(bets_and_none[k] * gained);
  }
}

// ln of the mixture's wealth against "E (sign x) <= sign null".
double log_wealth(const ValueCells& x, double sign, double null, double room) {
  OfBets logs{};
  for (const ValueCells::Cell& cell : x.cells()) {
    add_logs(cell.count - cell.at_largest, gain(sign * cell.least, sign * null, room), logs.data());
    if (cell.at_largest == 0) continue;
    add_logs(cell.at_largest, gain(sign * cell.largest, sign * null, room), logs.data());
  }
  return special::log_sum_of(std::span(logs).first(bet_count)) -
         std::log(static_cast<double>(bet_count));
}

void check_arguments(const char* function, const ValueCells& x, Range range, double null_mean) {
  check::finite({function, "null_mean"}, null_mean);
  if (!(range.low < range.high)) check::fail({function, "high"}, range.high, "above low");
  const double least = x.cells().front().least;
  const double largest = x.cells().back().largest;
  const auto slack = [](double end) { return std::isfinite(end) ? 1e-9 * std::abs(end) : 0; };
  if (!(least >= range.low - slack(range.low) - slack(range.high))) {
    check::fail({function, "least value"}, least, "inside the range");
  }
  if (!(largest <= range.high + slack(range.low) + slack(range.high))) {
    check::fail({function, "largest value"}, largest, "inside the range");
  }
}

struct Bettor {
  const ValueCells& values;
  Range range;

  // ln p of "sign E x <= sign null".
  double log_p(double sign, double null) const {
    // From the null to the end of the range below.
    const double room = sign > 0 ? null - range.low : range.high - null;
    if (room == infinity) return 0;
    const double mean_above = sign * (values.mean() - null);
    if (room < 0 || (room == 0 && mean_above > 0)) return special::lowest_log();
    // ln(1 + b g) is b g at most, so that no bet gains.
    if (room == 0 || mean_above <= 0) return 0;
    return special::clamp_log(-log_wealth(values, sign, null, room));
  }
};

// ln p of "sign (E x - scale E y) <= sign offset".
double log_p_contrast(const Bettor& x, const Bettor& y, Contrast null, double sign) {
  constexpr unsigned digits = 20;
  const double near = null.scale * y.values.mean() + null.offset;
  const double far = x.values.mean();
  if (sign * (far - near) <= 0) return 0;
  const double sign_of_y = -std::copysign(sign, sign * null.scale);
  double smallest = 0;
  // Both tails are the same where the larger one is smallest.
  const auto difference = [&](double part) {
    const double middle = near + part * (far - near);
    const double of_x = x.log_p(sign, middle);
    const double of_y = y.log_p(sign_of_y, (middle - null.offset) / null.scale);
    smallest = std::min(smallest, std::max(of_x, of_y));
    return of_x - of_y;
  };
  if (difference(0) < 0 && difference(1) > 0) root_bracket(difference, 0, 1, digits);
  return special::clamp_log(std::log(2.0) + smallest);
}

}  // namespace

ValueCells::ValueCells(std::span<const double> values) {
  check::at_least({"ValueCells", "count"}, values.size(), 1);
  std::vector<double> sorted(values.begin(), values.end());
  for (const double value : sorted) check::finite({"ValueCells", "value"}, value);
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  for (std::size_t begin = 0; begin < n;) {
    const std::size_t size = std::max<std::size_t>(1, std::min(begin, n - begin) / ranks_a_value);
    const std::size_t end = count_up_to(sorted, sorted[begin + size - 1]);
    cells_.push_back(cell_of(std::span<const double>(sorted).subspan(begin, end - begin)));
    begin = end;
  }
  count_ = static_cast<double>(n);
  for (const double value : sorted) mean_ += (value - sorted.front()) / count_;
  mean_ += sorted.front();
}

void ValueCells::add(double value, double weight) {
  check::finite({"ValueCells::add", "value"}, value);
  check::positive({"ValueCells::add", "weight"}, weight);
  const auto at = std::partition_point(cells_.begin(), cells_.end(),
                                       [&](const Cell& cell) { return cell.least < value; });
  cells_.insert(at, {.least = value, .largest = value, .count = weight});
  count_ += weight;
  mean_ += (value - mean_) * weight / count_;
}

TestResult betting_mean(const ValueCells& x, Range range, double null_mean) {
  check_arguments("betting_mean", x, range, null_mean);
  const Bettor bettor{x, range};
  return {
      x.mean() - null_mean, {"bound", {}}, bettor.log_p(-1, null_mean), bettor.log_p(1, null_mean)};
}

TestResult betting_contrast(const ValueCells& x, Range of_x, const ValueCells& y, Range of_y,
                            Contrast null_value) {
  check::finite({"betting_contrast", "scale"}, null_value.scale);
  check_arguments("betting_contrast", x, of_x, null_value.offset);
  if (null_value.scale == 0) return betting_mean(x, of_x, null_value.offset);
  check_arguments("betting_contrast", y, of_y, null_value.offset);
  const Bettor first{x, of_x};
  const Bettor second{y, of_y};
  return {x.mean() - null_value.scale * y.mean() - null_value.offset,
          {"bound", {}},
          log_p_contrast(first, second, null_value, -1),
          log_p_contrast(first, second, null_value, 1)};
}

BetGrowth bet_growth(const MovedLaw& law, std::size_t index) {
  const double stake = bets.at(index);
  const double null = law.sign * law.values.mean() - law.distance;
  double sum = 0;
  double squares = 0;
  for (const ValueCells::Cell& cell : law.values.cells()) {
    const double low = std::log1p(stake * gain(law.sign * cell.least, null, law.room));
    const double high = std::log1p(stake * gain(law.sign * cell.largest, null, law.room));
    const double at_low = cell.count - cell.at_largest;
    sum += at_low * low + cell.at_largest * high;
    squares += at_low * low * low + cell.at_largest * high * high;
  }
  const double mean = sum / law.values.count();
  return {mean, std::max(0.0, squares / law.values.count() - mean * mean)};
}

bool may_hide_values(std::span<const double> values, double mean, double end) {
  constexpr std::ptrdiff_t few = 32;
  const double half = mean + (end - mean) / 2;
  return std::ranges::count_if(values, [&](double value) {
           return end > mean ? value >= half : value <= half;
         }) < few;
}

}  // namespace assay::stats
