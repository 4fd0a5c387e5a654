#pragma once

// Four estimators from a source of pairs. Lambda is given, or comes from the same samples or from
// the other half of the samples. The fourth is the ratio of weighted importance sampling.

#include <functional>
#include <memory>

#include "correlated/pairs.h"

namespace assay::correlated {

/// lambda from sums over samples and the control's integral J.
using LambdaRule = std::function<double(const Sums&, double control_integral)>;

/// The centre about which the spread of the control is measured.
enum class Centre {
  integral,  ///< The centre is J. As published: lambda = sum d (mean f - f) / sum d^2.
  mean,      ///< The centre is the samples' mean. Lambda is the least-squares slope of f on g.
};

/// The estimate of lambda* from samples. It is 0 if the control's root mean square deviation is
/// below 2^-40 J: there is nothing to correct.
LambdaRule estimated_lambda(Centre);
/// The same moved into [0, 1].
LambdaRule clamped_lambda(Centre);

/// I^ with the lambda given: unbiased, the mean of its primaries. Channels: a colour each, with
/// mean and variance where they are known.
std::shared_ptr<const Setup> fixed(SharedPairs, double lambda);

/// The estimator with lambda from the same samples. With f and g divided by p its bias is
///   -E[(f - I - lambda* (g - J)) (g - J)^2] / (M Var g)
/// and terms of higher order. Channels: one a colour, then the diagnostic `lambda` (lambda_r,
/// lambda_g, lambda_b if there are several colours). Their limit lambda* is stated if it is known.
std::shared_ptr<const Setup> same_samples(SharedPairs, LambdaRule);

/// I^ by halves, each with the lambda of the other: unbiased. Of an odd M the second half is the
/// larger. A half of no or one sample gives lambda = 0. Channels as of same_samples(); lambda is
/// the mean of the two.
std::shared_ptr<const Setup> cross_fitted(SharedPairs, LambdaRule);

/// J sum(f/p) / sum(g/p), weighted importance sampling: biased like 1/M; 0 where all g/p are 0.
std::shared_ptr<const Setup> ratio(SharedPairs);

/// The channels of same_samples() and cross_fitted().
std::vector<Channel> channels_with_lambda(const PairSource&);

}  // namespace assay::correlated
