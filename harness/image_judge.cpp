#include "harness/image_judge.h"

#include <algorithm>
#include <cmath>

#include "harness/critical.h"
#include "stats/image_pyramid.h"

namespace assay::harness {

ImageTest image_test(const TestWork& work) {
  const TestOutcome& outcome = work.outcome;
  const std::vector<Subject>& subjects = outcome.question.subjects;
  return {.share = outcome.share(),
          .smallest_cell = outcome.plan.smallest_cell,
          .weights = outcome.plan.method.frozen.weights,
          .independent = std::all_of(subjects.begin(), subjects.end(),
                                     [](const Subject& s) { return s.image->independent; }),
          .flips = work.pools[0]->key(),
          .look = outcome.plan.look.get()};
}

ImageViews images_of(const TestWork& work, std::size_t subject) {
  return {work.pools[subject]->observations(work.outcome.secondaries()),
          work.outcome.question.subjects[subject].channels};
}

std::optional<double> detectable_uniformly(const TestOutcome& outcome, const TestSize& size,
                                           const ChannelOutcome& channel) {
  if (channel.regions.relation == Relation::within || channel.regions.allow > 0) return {};
  const double part = stats::whole_image_share(extent_of(*outcome.question.subjects[0].image));
  const double z =
      critical_value(size.share.alpha * part, true) + critical_value(size.share.beta, false);
  const double shrunk =
      std::sqrt(static_cast<double>(outcome.secondaries()) / static_cast<double>(size.secondaries));
  const double found = z * channel.image->uniform_error * shrunk;
  if (!std::isfinite(found)) return {};
  return found;
}

}  // namespace assay::harness
