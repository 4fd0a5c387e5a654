#include "harness/plan/drawn_order.h"

#include <fmt/format.h>

#include "harness/plan/gate_text.h"
#include "harness/plan/rows.h"

namespace assay::harness {

bool shows_order(const Subject& subject) {
  return !is_recorded(subject) && !subject.setup->image();
}

std::string why_dependent(const Subject& subject, std::span<const stats::Gate> order,
                          std::vector<Gate>& gates) {
  std::string why;
  for (const stats::Gate& gate : order) {
    if (gate.state != stats::GateState::red) continue;
    gates.push_back(gate_of(gate, ", " + subject.estimator->name));
    if (!why.empty()) continue;
    why = fmt::format(
        "the observations of `{}` are not independent: {}; an observation may rest on its own "
        "random numbers alone, not on what was drawn before it or beside it",
        subject.estimator->name, red_gates({gates.back()}));
  }
  return why;
}

void judge_drawn_order(const Question& question, const Pilots& pilots, Plan& plan) {
  for (const Subject& side : question.subjects) {
    const Pilot* pilot = pilot_of(side, pilots);
    if (!shows_order(side) || pilot == nullptr) continue;
    for (const std::size_t channel : side.channels) {
      if (channel >= pilot->order_gates.size()) continue;
      std::string why = why_dependent(side, pilot->order_gates[channel], plan.gates);
      if (plan.invalid.empty()) plan.invalid = std::move(why);
    }
  }
}

}  // namespace assay::harness
