#include <cmath>

#include "stats/basics/check.h"
#include "stats/tails/kolmogorov.h"
#include "stats/tails/smirnov.h"
#include "stats/tails/special.h"
#include "stats/tails/tails.h"

namespace assay::stats {
namespace {

std::uint64_t whole(double value) { return static_cast<std::uint64_t>(std::llround(value)); }

LogTails smirnov_tails(double distance, std::uint64_t m, std::uint64_t n) {
  LatticeDistance lattice{1, m, n};
  lattice.steps = whole(distance / lattice.value());
  LogTails tails;
  tails.upper = smirnov_upper_tail(lattice).log_p;
  ++lattice.steps;
  tails.lower = special::from_upper(smirnov_upper_tail(lattice).log_p).lower;
  return tails;
}

}  // namespace

LogTails log_tails(const Distribution& law, double x) {
  const auto parameter = [&](std::size_t index) {
    if (index >= law.parameters.size()) {
      check::fail({"log_tails", "parameters"}, law.parameters.size(), "enough for " + law.family);
    }
    return law.parameters[index];
  };
  if (law.family == "normal") return normal_tails(x);
  if (law.family == "student-t") return student_t_tails(x, parameter(0));
  if (law.family == "chi-square") return chi_square_tails(x, parameter(0));
  if (law.family == "F") return f_tails(x, {parameter(0), parameter(1)});
  if (law.family == "binomial") {
    return binomial_tails(whole(x), {whole(parameter(0)), parameter(1)});
  }
  if (law.family == "noncentral-chi-square") {
    return noncentral_chi_square_tails(x, {parameter(0), parameter(1)});
  }
  if (law.family == "kolmogorov") return kolmogorov_tails(x, whole(parameter(0)));
  if (law.family == "smirnov") return smirnov_tails(x, whole(parameter(0)), whole(parameter(1)));
  check::fail({"log_tails", "family"}, law.family, "the name of a law");
}

}  // namespace assay::stats
