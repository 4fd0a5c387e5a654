#include "stats/tabulated_law.h"

#include <algorithm>
#include <cmath>

#include "stats/check.h"

namespace assay::stats {
namespace {

struct Part {
  Span span;
  Integral first;   // of the lower half
  Integral second;  // of the upper half
  double error = 0;
  double chord = 0;
  double badness = 0;  // above 1: to be halved
  int depth = 0;

  bool operator<(const Part& other) const { return badness < other.badness; }
};

// The worst part is halved first, so that the evaluations that there are go where they help most.
class Table {
 public:
  Table(const AdaptiveQuadrature::Function& density, AdaptiveQuadrature& rule, TableLimits limits)
      : density_(density), rule_(rule), limits_(limits) {}

  void add(Span span) { add(span, rule_.once(density_, span), {}); }

  void refine() {
    while (parts_.front().badness > 1 && !rule_.exhausted()) {
      std::pop_heap(parts_.begin(), parts_.end());
      const Part part = parts_.back();
      parts_.pop_back();
      const Inherited inherited{part.chord / 4, part.depth + 1};
      add({part.span.low, part.span.middle()}, part.first, inherited);
      add({part.span.middle(), part.span.high}, part.second, inherited);
    }
  }

  TabulatedLaw result() {
    std::sort(parts_.begin(), parts_.end(),
              [](const Part& a, const Part& b) { return a.span.low < b.span.low; });
    TabulatedLaw law{.place = {parts_.front().span.low}, .cumulated = {0}};
    double largest_chord = 0;
    for (const Part& part : parts_) {
      append(law, part.span.middle(), part.first.value);
      append(law, part.span.high, part.second.value);
      law.total_error += part.error;
      largest_chord = std::max(largest_chord, part.chord);
    }
    check::positive({"tabulate", "mass"}, law.total());
    law.error = (largest_chord + law.total_error) / law.total();
    return law;
  }

 private:
  // Of the part that this is a half of. Halving takes a chord to a quarter where the density is
  // smooth; a part with a symmetric peak has halves of equal mass and would show none.
  struct Inherited {
    double chord = 0;
    int depth = 0;
  };

  void add(Span span, Integral whole, Inherited from) {
    Part part{.span = span,
              .first = rule_.once(density_, {span.low, span.middle()}),
              .second = rule_.once(density_, {span.middle(), span.high}),
              .depth = from.depth};
    const Integral sum = part.first + part.second;
    part.error = std::max(std::abs(sum.value - whole.value), sum.error);
    part.chord = std::max(std::abs(part.first.value - part.second.value) / 2, from.chord);
    if (part.depth < limits_.deepest_bisection) {
      part.badness = std::max(part.chord / limits_.chord, part.error / rule_.limits().tolerance);
    }
    if (part.depth == 0) part.badness = std::max(part.badness, 2.0);  // it has inherited nothing
    parts_.push_back(part);
    std::push_heap(parts_.begin(), parts_.end());
  }

  static void append(TabulatedLaw& law, double place, double mass) {
    law.place.push_back(place);
    law.cumulated.push_back(law.cumulated.back() + mass);
  }

  const AdaptiveQuadrature::Function& density_;
  AdaptiveQuadrature& rule_;
  TableLimits limits_;
  std::vector<Part> parts_;  // a heap, the worst first
};

}  // namespace

double TabulatedLaw::operator()(double x) const {
  if (x <= place.front()) return 0;
  if (x >= place.back()) return 1;
  const auto above =
      static_cast<std::size_t>(std::upper_bound(place.begin(), place.end(), x) - place.begin());
  const double share = (x - place[above - 1]) / (place[above] - place[above - 1]);
  return std::min(1.0, std::lerp(cumulated[above - 1], cumulated[above], share) / total());
}

TabulatedLaw tabulate(const AdaptiveQuadrature::Function& density, const std::vector<Span>& parts,
                      AdaptiveQuadrature& rule, TableLimits limits) {
  check::at_least({"tabulate", "number of parts"}, parts.size(), 1);
  Table table(density, rule, limits);
  for (const Span& part : parts) table.add(part);
  table.refine();
  return table.result();
}

}  // namespace assay::stats
