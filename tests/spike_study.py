#!/usr/bin/env python3
"""Mean tests on a constant with a rare spike, through the program as a user runs it.

    /usr/bin/python3 tests/spike_study.py --assay build/harness/assay [--seeds 400]

X = 1/2, and with probability p 1/2 + h, h = 1/(2 p) so that the spike is half of the mean 1; with
and without uniform noise of half width 0.1; with the range declared and not. The true claim
`mean(x) == 1` at level 0.01 of its own, 1e5 observations. Beside it the rate at which a plain t test
rejects it, a constant sample rejected where it is not 1 (numpy, 1e5 repetitions). The exit code says
whether no rate with a declared range exceeds 0.01 for certain (exact limit, 0.999 over the rows).
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import sys
import tempfile

import numpy
from scipy import stats

from study import lower_limit, tests_on_fixed_shares

OBSERVATIONS = 100_000
PROBABILITIES = (1e-3, 1e-4, 1e-5, 1e-6)
NOISES = (0, 0.1)
ALPHA = 0.01


def cases():
    for probability in PROBABILITIES:
        for noise in NOISES:
            for declared in (True, False):
                yield probability, noise, declared


def suite_text():
    """One suite of all cases: alpha is split over them, so that each has its own 0.01."""
    count = len(list(cases()))
    lines = ["suite: spike", f"alpha: {ALPHA * count:g}", "estimators:"]
    for i, (probability, noise, declared) in enumerate(cases()):
        lines.append(f"  x{i}: {{plugin: analytic/rare_spike, probability: {probability!r}, "
                     f"height: {0.5 / probability!r}, noise: {noise!r}, "
                     f"declared: {str(declared).lower()}, primaries: 1}}")
    lines.append("tests:")
    for i in range(count):
        lines.append(f"  - {{name: '{i}', claim: mean(x{i}) == 1, secondaries: {OBSERVATIONS}}}")
    return "\n".join(lines) + "\n"


def verdicts(assay, suite, seed):
    tests = tests_on_fixed_shares(assay, suite, seed)
    return [(test["verdict"], test["method"]) for test in tests]


def plain_t_rate(probability, noise, repetitions=100_000):
    """The sum of 1e5 values of the noise is normal, its sum of squares as good as known."""
    random = numpy.random.default_rng(1)
    n, height = OBSERVATIONS, 0.5 / probability
    spikes = random.binomial(n, probability, repetitions)
    deviation = noise / 3 ** 0.5
    mean = 0.5 + height * spikes / n + deviation * random.standard_normal(repetitions) / n ** 0.5
    variance = height ** 2 * spikes / n * (1 - spikes / n) + deviation ** 2
    with numpy.errstate(divide="ignore", invalid="ignore"):
        t = numpy.abs(mean - 1) / numpy.sqrt(variance / n)
    return float(numpy.mean(t > stats.t.isf(ALPHA / 2, n - 1)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()

    counts = [collections.Counter() for _ in cases()]
    methods = [collections.Counter() for _ in cases()]
    with tempfile.TemporaryDirectory() as name:
        suite = pathlib.Path(name) / "spike.yaml"
        suite.write_text(suite_text())
        with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
            for run in pool.map(lambda seed: verdicts(arguments.assay, suite, seed),
                                range(1, arguments.seeds + 1)):
                for i, (verdict, method) in enumerate(run):
                    counts[i][verdict] += 1
                    methods[i][method] += 1

    print(f"{arguments.seeds} runs of {OBSERVATIONS} observations; rates of the true claim")
    print("| p | noise | range | fail | pass | inconclusive | invalid | by | plain t |")
    print("|---|---|---|---|---|---|---|---|---|")
    bad = 0
    for i, (probability, noise, declared) in enumerate(cases()):
        share = {verdict: count / arguments.seeds for verdict, count in counts[i].items()}
        print(f"| {probability:g} | {noise or 'none'} | {'declared' if declared else 'unknown'} | "
              + " | ".join(f"{share.get(verdict, 0):.3g}"
                           for verdict in ("fail", "pass", "inconclusive", "invalid"))
              + f" | {methods[i].most_common(1)[0][0]} | {plain_t_rate(probability, noise):.3g} |")
        limit = lower_limit(counts[i]["fail"], arguments.seeds, 1 - 0.001 / len(counts))
        bad += declared and limit > ALPHA
    return 1 if bad else 0


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    sys.exit(main())
