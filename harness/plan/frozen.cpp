#include "harness/plan/frozen.h"

#include <algorithm>
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

void freeze(const Question& question, const Pilots& pilots, Plan& plan) {
  if (takes_from_pilot(plan.method)) freeze_cells(question, pilots, plan);
}

}  // namespace assay::harness
