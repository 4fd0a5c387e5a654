// Irradiance from a sky of radiance 1 + cos(theta), by two densities of directions. It is 5 pi / 3.
//
// Assay starts it as `./mine uniform`, and asks for observations on standard input.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>

namespace {

constexpr double pi = 3.14159265358979323846;
using Random = std::mt19937_64;
double draw(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// One sample f / p. Put your own estimator here.
double uniform_direction(Random& random) {
  const double cosine = draw(random);  // p = 1 / (2 pi)
  return (1 + cosine) * cosine * 2 * pi;
}

double cosine_direction(Random& random) {
  const double cosine = std::sqrt(draw(random));  // p = cosine / pi
  return (1 + cosine) * pi;
}

}  // namespace

int main(int count, char** words) {
  const bool uniform = count < 2 || std::strcmp(words[1], "uniform") == 0;
  double (*const sample)(Random&) = uniform ? uniform_direction : cosine_direction;
  std::puts("assay 1 binary\nchannel irradiance\naverages\nbias unbiased\nready");
  std::fflush(stdout);
  std::uint64_t question[4];  // key, first observation, number of observations, samples of each
  while (std::fread(question, sizeof *question, 4, stdin) == 4) {
    for (std::uint64_t i = question[1]; i < question[1] + question[2]; ++i) {
      // An observation depends on nothing but the key and its index.
      std::seed_seq seed{question[0], question[0] >> 32, i, i >> 32};
      Random random(seed);
      double sum = 0;
      for (std::uint64_t k = 0; k < question[3]; ++k) sum += sample(random);
      const double observation = sum / static_cast<double>(question[3]);
      std::fwrite(&observation, sizeof observation, 1, stdout);
    }
    std::fwrite(question, sizeof *question, 4, stdout);
    std::fflush(stdout);
  }
}
