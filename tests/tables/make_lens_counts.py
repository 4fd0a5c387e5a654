#!/usr/bin/python3
"""Lens samples in proportion to variance on rows of pixels across an edge: prints
tests/tables/lens_counts.csv.

The edge hides the part c(d) of a pixel's disc of confusion, the variance of a lens sample is
V = c (1 - c), and counts are max(1, K V rounded) with the largest K that keeps to the budget, found
by going through every K at which a count changes.
"""
import math


def coverage(d):
    """The part of a disc of radius 1 inside a half-plane, its edge at d, positive inside."""
    if abs(d) >= 1:
        return float(d > 0)
    return 1 - (math.acos(d) - d * math.sqrt(1 - d * d)) / math.pi


def counts(shares, mean):
    budget = mean * len(shares)

    def of(k):
        return [max(1, math.floor(k * s + .5)) for s in shares]

    # A count becomes n + 1 at K = (n + 1/2) / share.
    steps = sorted((n + .5) / s for s in shares if s > 0 for n in range(1, budget))
    low, high = 0, len(steps) - 1
    while low < high:
        middle = (low + high + 1) // 2
        # Just beyond the step, so that rounding does not decide.
        if sum(of(steps[middle] * (1 + 1e-12))) <= budget:
            low = middle
        else:
            high = middle - 1
    return of(steps[low] * (1 + 1e-12))


def row(width, size, samples):
    # The discs of `edge` have the radius 0.2 on the focal plane; the edge is at 0.
    places = [(i + .5 - width / 2) * size / width for i in range(width)]
    variances = [coverage(-x / .2) * coverage(x / .2) for x in places]
    n = counts(variances, samples)
    noise = [v / k for v, k in zip(variances, n)]
    seen = [s for s in noise if s > 0]
    worst = max(variances) / samples
    return [len(seen), max(variances) * width / sum(variances), worst / max(seen),
            max(seen) / min(seen), sum(seen) / sum(variances) * samples, " ".join(map(str, n))]


print("# /usr/bin/python3 tests/tables/make_lens_counts.py > tests/tables/lens_counts.csv")
print("width,size,samples,pixels_with_variance,max_over_mean,gain_of_worst,worst_over_quietest,"
      "total_over_uniform,counts")
for width, size, samples in ((120, 2.32, 64), (24, 2.32, 8), (60, 2, 32), (16, 1, 5)):
    few, ratio, gain, equal, total, n = row(width, size, samples)
    print(f"{width},{size},{samples},{few},{ratio:.12g},{gain:.12g},{equal:.12g},{total:.12g},{n}")
