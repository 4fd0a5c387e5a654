// Power and false alarms of the family of an image pair (stats/image_pyramid.h). Prints one line a
// row: name, repetitions, rates. Seed 1.

//   image_power stacks REPETITIONS          Defects at 128 x 128, 16 and 64 replicates a side.
//   image_power level REPETITIONS [LAW]     False alarms under six laws.
//   image_power samples REPETITIONS         2 million samples of a 48 x 48 image.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "stats/images/image_welch.h"
#include "stats/means/binomial.h"
#include "stats/pyramids/image_pyramid.h"
#include "stats/tails/tails.h"
#include "tests/philox.h"
#include "tests/stats/image_samples.h"

namespace {

using namespace assay;
using tests::Defect;
using tests::Philox;

constexpr double alpha = 1e-3;

bool rejects(const stats::ImageFamily& family, double level) {
  return family.log_p <= std::log(level);
}

// The defects in units of the standard error of a - b, which needs two stacks of unit law scaled.
void stacks(std::size_t repetitions) {
  const stats::ImageExtent extent{128, 128, 1};
  for (const std::size_t replicates : {16UL, 64UL}) {
    std::uint32_t test_case = 9100;
    for (const Defect& defect : tests::defects()) {
      Philox random(test_case++);
      std::size_t found = 0;
      for (std::size_t i = 0; i < repetitions; ++i) {
        std::vector<double> shift(extent.elements());
        tests::add_defect(shift, extent, defect, random);
        const double unit = std::sqrt(2.0 / static_cast<double>(replicates));
        const auto a = tests::draw_stack(
            extent, replicates, [&](std::size_t e) { return random.normal() + shift[e] * unit; });
        const auto b =
            tests::draw_stack(extent, replicates, [&](std::size_t) { return random.normal(); });
        found += rejects(stats::image_pyramid(a.view(), b.view()), alpha);
      }
      std::printf("R = %zu | %-24s | %.3f\n", replicates, defect.name,
                  static_cast<double>(found) / static_cast<double>(repetitions));
      std::fflush(stdout);
    }
  }
}

// Counts of rejections at .01, .001, .0001.
struct Rates {
  std::size_t repetitions = 0;
  std::size_t counts[3] = {};

  void add(double log_p) {
    ++repetitions;
    for (int k = 0; k < 3; ++k) counts[k] += log_p <= std::log(std::pow(10, -2 - k));
  }
  // The exact lower 99.9 % limit of a rate: ln P(count or more) at alpha says whether it is above.
  void print(const char* name) const {
    std::printf("%-52s | %zu", name, repetitions);
    for (int k = 0; k < 3; ++k) {
      const double level = std::pow(10, -2 - k);
      const double log_p = stats::binomial_tails(counts[k], {repetitions, level}).upper;
      std::printf(" | %.5f%s", static_cast<double>(counts[k]) / static_cast<double>(repetitions),
                  log_p < std::log(1e-3) ? " (above)" : "");
    }
    std::printf("\n");
    std::fflush(stdout);
  }
};

// Adding up the elements' own z, for comparison: |sum z| / sqrt n of the whole image.
double added_z(const std::vector<double>& z) {
  double sum = 0;
  for (const double value : z) sum += value;
  const stats::LogTails tails = stats::normal_tails(sum / std::sqrt(static_cast<double>(z.size())));
  return std::min(0.0, std::log(2.0) + std::min(tails.lower, tails.upper));
}

double energy_of_z(const std::vector<double>& z) {
  double sum = 0;
  for (const double value : z) sum += value * value;
  return stats::chi_square_tails(sum, static_cast<double>(z.size())).upper;
}

struct Law {
  const char* name;
  double shape;   // gamma shape of a replicate with mean 1 and variance 1 / shape; 0: normal
  double factor;  // variance of a over that of b
  bool reference;
};

void level_of(const Law& law, const stats::ImageExtent& extent, std::size_t replicates,
              std::size_t repetitions, std::uint32_t test_case) {
  Philox random(test_case);
  Rates family, sum, energy;
  Rates parts[4];  // of the family: elements, windows, alternating, energy
  const auto draw = [&](double shape, std::size_t e) {
    // Brightness rises over the image by a factor of 50, and so does the standard deviation.
    const double bright = 1 + 49 * static_cast<double>(e) / static_cast<double>(extent.elements());
    return bright * (shape == 0 ? 1 + random.normal() : tests::gamma(random, shape) / shape);
  };
  std::vector<double> truth(extent.elements());
  for (std::size_t e = 0; e < truth.size(); ++e) {
    truth[e] = 1 + 49 * static_cast<double>(e) / static_cast<double>(truth.size());
  }
  for (std::size_t i = 0; i < repetitions; ++i) {
    const auto a = tests::draw_stack(
        extent, replicates, [&](std::size_t e) { return draw(law.shape / law.factor, e); });
    std::vector<double> z(extent.elements());
    stats::ImageFamily result;
    if (law.reference) {
      const stats::ImageReference reference{extent, truth};
      result = stats::image_pyramid(a.view(), reference);
      stats::welch_z(a.view(), reference, 0, z);
    } else {
      const auto b =
          tests::draw_stack(extent, replicates, [&](std::size_t e) { return draw(law.shape, e); });
      result = stats::image_pyramid(a.view(), b.view());
      stats::welch_z(a.view(), b.view(), 0, z);
    }
    family.add(result.log_p);
    double best[4] = {};
    for (const auto& g : result.groups) {
      const std::size_t part = g.statistic == stats::ImageStatistic::energy        ? 3
                               : g.statistic == stats::ImageStatistic::alternating ? 2
                               : g.size > 1                                        ? 1
                                                                                   : 0;
      best[part] = std::min(best[part], g.adjusted_log_p);
    }
    for (int k = 0; k < 4; ++k) parts[k].add(best[k]);
    sum.add(added_z(z));
    energy.add(energy_of_z(z));
  }
  const std::string name = std::string(law.name) + ", " + std::to_string(extent.width) +
                           "^2, R = " + std::to_string(replicates);
  family.print((name + ": family").c_str());
  parts[0].print((name + ":   elements").c_str());
  parts[1].print((name + ":   windows").c_str());
  parts[2].print((name + ":   alternating").c_str());
  parts[3].print((name + ":   energy").c_str());
  sum.print((name + ": (sum z / sqrt n)").c_str());
  energy.print((name + ": (sum z^2 as chi-square)").c_str());
}

void level(std::size_t repetitions, std::size_t only) {
  const Law laws[] = {
      {"normal", 0, 1, false},
      {"gamma 25", 25, 1, false},
      {"gamma 25, 3 x variance", 25, 3, false},
      {"exponential", 1, 1, false},
      {"gamma 25, reference", 25, 1, true},
      {"normal, reference", 0, 1, true},
  };
  std::uint32_t test_case = 9200;
  for (std::size_t i = 0; i < std::size(laws); ++i, test_case += 2) {
    if (only < std::size(laws) && i != only) continue;
    level_of(laws[i], {32, 32, 1}, 16, repetitions, test_case);
    level_of(laws[i], {32, 32, 1}, 64, repetitions / 4, test_case + 1);
  }
}

// Two million samples of a 48 x 48 image whose elements have coefficient of variation 1
// (exponential samples), in 64 replicates.
void samples(std::size_t repetitions) {
  const stats::ImageExtent extent{48, 48, 1};
  const std::size_t replicates = 64;
  const double shape = 2e6 / static_cast<double>(extent.elements() * replicates);
  const auto bright = [&](std::size_t e) { return 1 + 0.5 * std::sin(static_cast<double>(e)); };
  const auto stack = [&](Philox& random, double bias, double factor) {
    return tests::draw_stack(extent, replicates, [&](std::size_t e) {
      return bright(e) * (1 + bias) * tests::gamma(random, shape / factor) / (shape / factor);
    });
  };
  std::vector<double> truth(extent.elements());
  for (std::size_t e = 0; e < truth.size(); ++e) truth[e] = bright(e);
  struct Case {
    const char* name;
    double bias;
    double factor;
    bool reference;
  };
  const Case cases[] = {{"bias .35 %, exact reference", .0035, 1, true},
                        {"bias .5 %, two stacks", .005, 1, false},
                        {"no bias, three times the variance", 0, 3, false},
                        {"no bias, exact reference", 0, 1, true},
                        {"no bias, two stacks", 0, 1, false}};
  std::uint32_t test_case = 9400;
  for (const Case& one : cases) {
    Philox random(test_case++);
    Rates rates;
    for (std::size_t i = 0; i < repetitions; ++i) {
      const auto a = stack(random, one.bias, one.factor);
      if (one.reference) {
        rates.add(stats::image_pyramid(a.view(), stats::ImageReference{extent, truth}).log_p);
      } else {
        const auto b = stack(random, 0, 1);
        rates.add(stats::image_pyramid(a.view(), b.view()).log_p);
      }
    }
    rates.print(one.name);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "stacks";
  const std::size_t repetitions = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 400;
  const std::size_t only = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : repetitions;
  if (what == "stacks") stacks(repetitions);
  if (what == "level") level(repetitions, only);
  if (what == "samples") samples(repetitions);
}
