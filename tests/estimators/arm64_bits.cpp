// Prints numbers to the last bit, a line each: random words, functions of the C library, and what
// stats/ computes. tests/arm64.sh compares the lines of two processors.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "estimators/core/flush_denormals.h"
#include "estimators/stream.h"
#include "stats/basics/moments.h"
#include "stats/laws/kolmogorov_smirnov.h"
#include "stats/means/betting_mean.h"
#include "stats/means/skewness_corrected_t.h"
#include "stats/means/student_t.h"
#include "stats/tails/tails.h"

namespace {

using namespace assay;
using namespace assay::stats;

constexpr StreamKey key{0x123456789abcdef};

/// FNV-1a of the bits of all values.
class Hash {
 public:
  void add(std::uint64_t word) { state_ = (state_ ^ word) * 0x100000001b3; }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void print(const char* what) const {
    std::printf("%s %016llx\n", what, static_cast<unsigned long long>(state_));
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325;
};

void print_streams() {
  Hash one;
  Hash ahead;
  for (std::uint64_t observation = 0; observation < 100; ++observation) {
    Stream stream(key, observation);
    for (int i = 0; i < 100; ++i) one.add(stream.uniform());
    stream.draw_ahead();
    for (int i = 0; i < 100; ++i) ahead.add(stream());
  }
  one.print("stream one by one");
  ahead.print("stream ahead");
}

/// A hash of a function at 10^5 places of an interval.
template <class Function>
void print_function(const char* name, double low, double high, const Function& function) {
  Hash hash;
  Stream stream(key, 1);
  for (int i = 0; i < 100000; ++i) hash.add(function(low + (high - low) * stream.uniform()));
  hash.print(name);
}

void print_library() {
  const auto print = [](const char* name, double low, double high, double (*function)(double)) {
    print_function(name, low, high, function);
  };
  print("libm sqrt", 0, 10, [](double x) { return std::sqrt(x); });
  print("libm exp", -700, 700, [](double x) { return std::exp(x); });
  print("libm log", 0, 10, [](double x) { return std::log(x); });
  print("libm pow", 0, 10, [](double x) { return std::pow(x, 1.7); });
  print("libm sin", -10, 10, [](double x) { return std::sin(x); });
  print("libm cos", -10, 10, [](double x) { return std::cos(x); });
  print("libm atan", -10, 10, [](double x) { return std::atan(x); });
  print("libm expm1", -2, 2, [](double x) { return std::expm1(x); });
  print("libm log1p", -.9, 2, [](double x) { return std::log1p(x); });
  print("libm erfc", -3, 20, [](double x) { return std::erfc(x); });
  print("libm lgamma", 0, 100, [](double x) { return std::lgamma(x); });
  print("libm cbrt", 0, 10, [](double x) { return std::cbrt(x); });
  print("libm tanh", -2, 2, [](double x) { return std::tanh(x); });
}

void print_tails() {
  const auto print = [](const char* name, double low, double high, const auto& tails) {
    print_function(name, low, high, [&](double x) {
      const LogTails both = tails(x);
      return both.lower < both.upper ? both.lower : both.upper;
    });
  };
  print("tails normal", -40, 40, [](double x) { return normal_tails(x); });
  print("tails t", -40, 40, [](double x) { return student_t_tails(x, 7.5); });
  print("tails chi-square", 0, 100, [](double x) { return chi_square_tails(x, 12); });
  print("tails F", 0, 30, [](double x) { return f_tails(x, {5, 11.5}); });
  print("tails beta", 0, 1, [](double x) { return beta_tails(x, {.7, 3}); });
}

/// Samples without a function of the C library: sums of three uniforms.
std::vector<double> sample_of(std::uint64_t first, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    Stream stream(key, first + i);
    values.push_back(stream.uniform() + stream.uniform() + stream.uniform());
  }
  return values;
}

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  for (const double value : values) moments.add(value);
  return moments;
}

void print_result(const char* name, const TestResult& result) {
  std::printf("test %s %a %a %a\n", name, result.statistic, result.log_p_lower, result.log_p_upper);
}

void print_tests() {
  std::vector<double> x = sample_of(0, 1000);
  std::vector<double> y = sample_of(1000, 700);
  const Moments mx = moments_of(x);
  const Moments my = moments_of(y);
  std::printf("moments %a %a %a %a\n", mx.mean, mx.m2, mx.m3, mx.m4);
  print_result("t", student_t(mx, {.value = 1.5}));
  print_result("Welch", welch_t(mx, my, {}));
  print_result("skewness-corrected t", skewness_corrected_t(mx, {.value = 1.5}));
  print_result("betting mean", betting_mean(ValueCells(x), {0, 3}, 1.4));
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  print_result("two-sample Kolmogorov-Smirnov", kolmogorov_smirnov(ks_distance(x, y)));
  const auto law = [](double value) { return value * value * (3 - value * 2 / 3) / 9; };
  print_result("Kolmogorov-Smirnov", kolmogorov_smirnov(ks_distance(x, law)));
}

}  // namespace

int main() {
  print_streams();
  print_library();
  print_tails();
  print_tests();
  const FlushDenormals flush;
  volatile double least = 0x1p-1022;
  std::printf("denormals %a %d\n", least / 2, FlushDenormals::is_on());
}
