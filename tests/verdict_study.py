#!/usr/bin/env python3
"""Verdicts on laws of every shape, through the program as a user runs it.

    /usr/bin/python3 tests/verdict_study.py --assay build/harness/assay [--seeds 200] [--first 1] [--part TEXT]

tests/verdict_laws.c holds the laws; means, variances and skewnesses stand below. Each part is a quantity and a
kind of source: `average` declares that observations are means of its primaries, `raw` gives single draws,
`declared` declares their range. Each
claim stands true and off by exactly `detect`, at alpha = beta = 0.01 of its own. `cost` compares the observations
to the verdict with the fixed size of a known normal law, at biases of 0, 1/2, 1 and 5 `detect`.

The exit code says whether no rate of false fails and none of false passes exceeds 0.01 for certain (exact 99.9 %
limits) where the moments exist that the test needs.
"""

import argparse
import collections
import concurrent.futures
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

from study import lower_limit, record_of

ALPHA = BETA = 0.01
NEVER = math.inf
BASE = 10.0  # is added to every law, so that no margin is larger than its reference
LAWS_OF_A_SUITE = 20  # alpha of a suite is 0.5 at most


def lognormal(s):
    w = math.exp(s * s)
    return math.sqrt(w), (w - 1) * w, (w + 2) * math.sqrt(w - 1)


def pareto(a):
    variance = a / ((a - 1) ** 2 * (a - 2)) if a > 2 else NEVER
    skewness = 2 * (1 + a) / (a - 3) * math.sqrt((a - 2) / a) if a > 3 else NEVER
    return a / (a - 1), variance, skewness


def of_moments(m1, m2, m3):
    """Mean, variance and skewness from three raw moments."""
    variance = m2 - m1 * m1
    return m1, variance, (m3 - 3 * m1 * m2 + 2 * m1 ** 3) / variance ** 1.5


def happens(p):
    return p, p * (1 - p), (1 - 2 * p) / math.sqrt(p * (1 - p))


def spike(p):
    mean, variance, skewness = happens(p)
    return 0.5 + 0.5 / p * mean, (0.5 / p) ** 2 * variance, skewness


# Mean, variance, skewness.
LAWS = {
    "normal": (5, 1, 0), "uniform": (0.5, 1 / 12, 0), "exponential": (1, 1, 2),
    "gamma_half": (0.5, 0.5, math.sqrt(8)), "gamma_2": (2, 2, math.sqrt(2)),
    "beta_2_5": (2 / 7, 10 / 392, 0.596), "lognormal_05": lognormal(0.5), "lognormal_1": lognormal(1),
    "lognormal_15": lognormal(1.5), "lognormal_2": lognormal(2), "pareto_15": pareto(1.5),
    "pareto_21": pareto(2.1), "pareto_3": pareto(3), "pareto_5": pareto(5), "pareto_10": pareto(10),
    "student_3": (0, 3, NEVER), "student_5": (0, 5 / 3, 0), "laplace": (0, 2, 0),
    "logistic": (0, math.pi ** 2 / 3, 0), "gumbel": (0.5772156649015329, math.pi ** 2 / 6, 1.14),
    "weibull_half": of_moments(2, 24, 720), "arcsine": (0.5, 1 / 8, 0), "triangular": (1, 1 / 6, 0),
    "rayleigh": (math.sqrt(math.pi / 2), 2 - math.pi / 2, 0.631), "poisson_1": (1, 1, 1),
    "geometric_3": (0.7 / 0.3, 0.7 / 0.09, 1.3 / math.sqrt(0.7)), "bernoulli_3": happens(0.3),
    "bernoulli_01": happens(0.01), "bernoulli_001": happens(0.001),
    "rare_tenth": of_moments(0.1, 0.2, 0.6), "rare_hundredth": of_moments(0.01, 0.02, 0.06),
    "spike_hundredth": spike(0.01), "spike_thousandth": spike(0.001), "spike_1e4": spike(1e-4), "spike_1e5": spike(1e-5), "noisy_spike_1e4": spike(1e-4),
    "two_lobes": (0, 4.09, 0),
    "contaminated": (0, 1.99, 0), "tenth_power": of_moments(1 / 11, 1 / 21, 1 / 31),
    "firefly": (1 + 0.01 / 0.6, 1 / 12 + 0.05 - (0.01 / 0.6) ** 2, NEVER),
}
# Laws in a range from 0 on, which the kind `declared` declares.
RANGED = ["uniform", "beta_2_5", "arcsine", "triangular", "bernoulli_3", "bernoulli_01", "bernoulli_001",
          "spike_hundredth", "spike_thousandth", "spike_1e4", "spike_1e5", "noisy_spike_1e4", "tenth_power"]
# The variance of a variance does not exist.
NO_FOURTH_MOMENT = {"pareto_15", "pareto_21", "pareto_3", "student_3", "firefly"}


def mean_margin(law):
    mean, variance, _ = LAWS[law]
    return 0.03 * (math.sqrt(variance) if variance < NEVER else mean)


# The right side of each claim about the law of x if it is true, and if it is off by `detect`.
def mean_claims(law, margin):
    mean = BASE + LAWS[law][0]
    return f"mean(x) == {mean!r}", f"mean(x) == {mean - margin!r}", f"{margin!r}"


def low_claims(law, margin):
    """Of a declared range: the margin is a fifth of the mean."""
    mean = LAWS[law][0]
    return f"mean(x) == {mean!r}", f"mean(x) == {0.8 * mean!r}", "20%"


def high_claims(law, margin):
    mean = LAWS[law][0]
    return f"mean(x) == {mean!r}", f"mean(x) == {1.25 * mean!r}", "20%"


def means_claims(law, margin):
    return "mean(x) == mean(y)", "mean(x) == mean(off)", f"{margin!r}"


def variance_claims(law, margin):
    variance = LAWS[law][1]
    if variance == NEVER:
        return None
    return f"variance(x) == {variance!r}", f"variance(x) == {variance / 1.3!r}", "30%"


def variances_claims(law, margin):
    return "variance(x) == variance(y)", "variance(x) == 1.3 * variance(y)", "30%"


def efficiency_claims(law, margin):
    return "efficiency(x) == efficiency(y)", "efficiency(x) == 1.3 * efficiency(y)", "30%"


def law_claims(law, margin):
    return "distribution(x) == distribution(y)", None, "0.1"


QUANTITIES = {"mean": mean_claims, "mean claimed low": low_claims, "mean claimed high": high_claims, "means": means_claims, "variance": variance_claims,
              "variances": variances_claims, "efficiencies": efficiency_claims, "laws": law_claims}


def estimator(name, library, kind, law, shift):
    return (f"  {name}: {{plugin: library, file: {library}, estimator: {kind}, "
            f"parameters: {{law: {law}, shift: {shift!r}}}}}")


def suite_text(quantity, kind, library, budget, laws):
    """A suite of these laws. Its alpha is split over the tests, so that each has its own."""
    tests, estimators = [], []
    for law in laws:
        margin = mean_margin(law)
        claims = QUANTITIES[quantity](law, margin)
        if claims is None:
            continue
        # A name of its own gives each estimator a stream of its own.
        base = 0.0 if kind == "declared" else BASE
        for name, shift in (("x", base), ("y", base), ("off", base + margin)):
            estimators.append(estimator(f"{law}_{name}", library, kind, law, shift))
        for truth, claim in zip(("true", "false"), claims[:2]):
            if claim is None:
                continue
            for name in ("x", "y", "off"):
                claim = claim.replace(f"({name})", f"({law}_{name})")
            tests.append(f"  - {{name: {law} {truth}, claim: {claim}, detect: {claims[2]}, budget: {budget:g}}}")
    return "\n".join([f"suite: {quantity} {kind} {laws[0]}", f"alpha: {ALPHA * len(tests)!r}", f"beta: {BETA!r}",
                      "estimators:", *estimators, "tests:", *tests]) + "\n"


def verdicts(assay, suites, seed):
    return [(test["name"], test["verdict"])
            for suite in record_of(assay, suites, seed)["suites"] for test in suite["tests"]]


def study(quantity, kind, arguments, library, folder, pool):
    """Prints a table of a part; returns the cells that are certainly above their promise."""
    suites = []
    laws = RANGED if kind == "declared" else list(LAWS)
    for first in range(0, len(laws), LAWS_OF_A_SUITE):
        suites.append(folder / f"{quantity}-{kind}-{first}.yaml")
        suites[-1].write_text(suite_text(quantity, kind, library, arguments.budget,
                                         laws[first:first + LAWS_OF_A_SUITE]), encoding="utf-8")
    counts = collections.defaultdict(collections.Counter)
    seeds = range(arguments.first, arguments.first + arguments.seeds)
    for results in pool.map(lambda seed: verdicts(arguments.assay, suites, seed), seeds):
        for name, verdict in results:
            counts[name][verdict] += 1
    print(f"\n| {quantity}, {kind} | skewness | false fails | open, invalid of true | false passes | open, invalid of false |"
          "\n|---|---|---|---|---|---|")
    broken = []
    for law, (_, variance, skewness) in LAWS.items():
        true, false = counts[f"{law} true"], counts[f"{law} false"]
        if not true:
            continue
        print(f"| {law} | {skewness:.3g} | {true['fail']} | {true['inconclusive']}, {true['invalid'] + true['error']} "
              f"| {false['pass']} | {false['inconclusive']}, {false['invalid'] + false['error']} |")
        needs_fourth = quantity in ("variance", "variances", "efficiencies")
        if variance == NEVER or (needs_fourth and law in NO_FOURTH_MOMENT):
            continue
        for wrong in (true["fail"], false["pass"]):
            if lower_limit(wrong, arguments.seeds, 0.999) > ALPHA:
                broken.append(f"{quantity} {kind} {law}: {wrong} of {arguments.seeds}")
    sys.stdout.flush()
    return broken


def costs(arguments, library, folder, pool):
    """Observations of normal means to the verdict, over the fixed size of a known law."""
    z = statistics.NormalDist().inv_cdf
    detect = 0.005
    fixed = ((z(1 - ALPHA / 2) + z(1 - BETA)) / detect) ** 2
    biases = (0, 0.5, 1, 5)
    lines = [estimator(f"x{i}", library, "raw", "normal", 1e-9 * i) for i in range(len(biases))]
    tests = [f"  - {{name: '{bias}', claim: mean(x{i}) == {5 - bias * detect!r}, detect: {detect!r}}}"
             for i, bias in enumerate(biases)]
    suite = folder / "cost.yaml"
    suite.write_text("\n".join(["suite: cost", f"alpha: {ALPHA * len(biases)!r}", f"beta: {BETA!r}", "estimators:", *lines,
                                "tests:", *tests]) + "\n", encoding="utf-8")
    taken = collections.defaultdict(list)
    ends = collections.defaultdict(collections.Counter)

    def run(seed):
        return record_of(arguments.assay, [suite], seed)["suites"][0]["tests"]

    for results in pool.map(run, range(arguments.first, arguments.first + arguments.seeds)):
        for test in results:
            taken[test["name"]].append(test["samples"][0]["secondaries"] / fixed)
            ends[test["name"]][test["verdict"]] += 1
    print("\n| bias over detect | mean size over fixed | largest | verdicts |\n|---|---|---|---|")
    for bias, ratios in taken.items():
        print(f"| {bias} | {statistics.mean(ratios):.3f} | {max(ratios):.3f} | {dict(ends[bias])} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--budget", type=float, default=4e6, help="primaries a test may take")
    parser.add_argument("--part", default="", help="only parts whose name has this text, such as `mean, raw`")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    arguments.assay = str(pathlib.Path(arguments.assay).resolve())
    here = pathlib.Path(__file__).resolve().parent
    broken = []
    with (tempfile.TemporaryDirectory() as name,
          concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool):
        folder = pathlib.Path(name)
        library = folder / "laws.so"
        subprocess.run(["cc", "-std=c11", "-O2", "-fPIC", "-shared", "-I", here.parent / "estimators",
                        here / "verdict_laws.c", "-o", library, "-lm"], check=True)
        for quantity in QUANTITIES:
            for kind in ("declared",) if "claimed" in quantity else ("average", "raw"):
                if arguments.part in f"{quantity}, {kind}":
                    broken += study(quantity, kind, arguments, library, folder, pool)
        if arguments.part in "cost":
            costs(arguments, library, folder, pool)
    for cell in broken:
        print(f"above its promise: {cell}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
