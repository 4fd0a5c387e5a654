#include "harness/plan/frozen.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "harness/plan/image_plan.h"
#include "harness/plan/pilot_shape.h"
#include "harness/plan/rows.h"
#include "harness/question/declared_range.h"

namespace assay::harness {
namespace {

// 64 pilot points of both sides to a cell.
constexpr stats::CellNumbers plane_cells{.bands = 16, .cuts = 16};
constexpr stats::CellNumbers line_cells{.bands = 64, .cuts = 1};

/// True if this side's pilot may choose. Rows may only if no side has a pilot of its own.
bool may_choose(const Question& question, std::size_t subject) {
  return !is_recorded(question.subjects[subject]) ||
         std::all_of(question.subjects.begin(), question.subjects.end(), is_recorded);
}

std::vector<double> pilot_values(const Question& question, std::size_t subject, std::size_t channel,
                                 const Pilots& pilots, const Plan& plan) {
  const Subject& side = question.subjects[subject];
  if (pilot_of(side, pilots) == nullptr || !may_choose(question, subject)) return {};
  return as_secondaries(side, pilot_channel(question, subject, channel, pilots).values,
                        plan.primaries[subject]);
}

/// Drops values from buckets with fewer than `least`: few continuous values are left to sort.
void drop_rare(std::vector<double>& values, double least) {
  constexpr int bits = 14;
  const auto bucket = [](double value) {
    const auto word = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 counts as 0
    return static_cast<std::size_t>((word * 0x9E3779B97F4A7C15) >> (64 - bits));
  };
  std::vector<std::uint32_t> counts(std::size_t{1} << bits);
  for (const double value : values) ++counts[bucket(value)];
  std::erase_if(values, [&](double value) { return counts[bucket(value)] < least; });
}

std::optional<Atom> most_frequent(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  const auto total = static_cast<double>(values.size());
  drop_rare(values, least_atom * total);
  std::sort(values.begin(), values.end());
  std::optional<Atom> atom;
  for (auto begin = values.begin(); begin != values.end();) {
    const auto end = std::upper_bound(begin, values.end(), *begin);
    const double share = static_cast<double>(end - begin) / total;
    const bool again = end - begin > 1 && share >= least_atom;
    if (again && (!atom || share > atom->share)) atom = Atom{.value = *begin, .share = share};
    begin = end;
  }
  return atom;
}

bool is_of_draws(const Question& question) {
  return std::any_of(question.subjects.begin(), question.subjects.end(),
                     [](const Subject& side) { return !side.purpose.empty(); });
}

/// Both sides' pilot points, without draws that yield none.
std::vector<stats::PlanePoint> pilot_points(const Question& question, const Pilots& pilots,
                                            const Plan& plan) {
  std::vector<stats::PlanePoint> points;
  for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
    const Subject& side = question.subjects[subject];
    const std::vector<double> first = pilot_values(question, subject, 0, pilots, plan);
    const std::vector<double> second = side.channels.size() > 1
                                           ? pilot_values(question, subject, 1, pilots, plan)
                                           : std::vector<double>(first.size(), 0);
    const std::optional<double> none = no_point_of(side);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] != none && std::isfinite(first[i]) && std::isfinite(second[i])) {
        points.push_back({first[i], second[i]});
      }
    }
  }
  return points;
}

void freeze_cells(const Question& question, const Pilots& pilots, Plan& plan) {
  std::vector<stats::PlanePoint> points = pilot_points(question, pilots, plan);
  if (points.empty()) {
    plan.invalid = "the pilots gave no point to choose cells by";
    return;
  }
  const bool plane = question.subjects[0].channels.size() > 1;
  plan.method.frozen.cells = std::make_shared<const stats::SampledCells>(
      stats::sampled_cells(std::move(points), plane ? plane_cells : line_cells));
}

}  // namespace

bool takes_from_pilot(const Method& method) { return method.is.from_pilot != FromPilot::nothing; }

std::vector<std::optional<Atom>> atoms_of(const Question& question, const Pilots& pilots,
                                          const Plan& plan) {
  std::vector<std::optional<Atom>> atoms;
  if (is_of_draws(question)) return atoms;
  for (std::size_t channel = 0; channel < question.channel_count(); ++channel) {
    std::vector<double> both;
    for (std::size_t subject = 0; subject < question.subjects.size(); ++subject) {
      const auto values = pilot_values(question, subject, channel, pilots, plan);
      both.insert(both.end(), values.begin(), values.end());
    }
    atoms.push_back(most_frequent(std::move(both)));
  }
  return atoms;
}

bool has_atom(const std::vector<std::optional<Atom>>& atoms) {
  return std::any_of(atoms.begin(), atoms.end(), [](const auto& atom) { return atom.has_value(); });
}

void freeze(const Question& question, const Pilots& pilots, Plan& plan) {
  const FromPilot wanted = plan.method.is.from_pilot;
  if (wanted == FromPilot::cells) {
    freeze_cells(question, pilots, plan);
  } else if (wanted == FromPilot::weights) {
    plan.method.frozen.weights = image_weights(question, pilots, plan);
  } else if (wanted == FromPilot::atoms) {
    plan.method.frozen.atoms = atoms_of(question, pilots, plan);
    if (has_atom(plan.method.frozen.atoms)) return;
    plan.invalid =
        "`two-part-ks` splits off a value that comes again and again, and the pilots show none "
        "that "
        "is one in a hundred; leave `test` out";
  }
}

}  // namespace assay::harness
