#!/usr/bin/env python3
"""Verdicts and sample counts over biases, through the program as a user runs it.

    python3 tests/bias_study.py --assay build/harness/assay [--seeds 1000]

Normal data of standard deviation 1; `mean(x) == 1`, detect 0.01, allow 0.005 and 0, alpha 1e-3 and
beta 1e-2 for each test, biases from 0 to 5 detect. Rates with exact 99.9 % limits, and the mean number
of observations over that of the fixed-n design, ((z_alpha/2 + z_beta) / (detect - allow))^2 (with
allow 0 the two-sided test, else two one-sided ones, as planned). The exit code says whether no
mistake is above its rate for certain, and, with allow, whether fewer than 0.25 of the fixed-n
observations are taken at bias 0 and fewer than 0.02 at 0.05.
"""

import argparse
import collections
import concurrent.futures
import pathlib
import statistics
import sys
import tempfile

from study import lower_limit, tests_on_fixed_shares

ALPHA, BETA, DETECT = 1e-3, 1e-2, 0.01
ALLOWS = (0.005, 0)
BIASES = (0, 0.005, 0.01, 0.02, 0.05)
CONFIDENCE = 0.999


def cases():
    for allow in ALLOWS:
        for bias in BIASES:
            yield allow, bias


def suite_text():
    """One suite of all cases: alpha is split over them, so that each has its own."""
    lines = ["suite: bias", f"alpha: {ALPHA * len(list(cases())):g}", f"beta: {BETA!r}",
             "estimators:"]
    for i, (_, bias) in enumerate(cases()):
        # A mean of its own gives every test a stream of its own.
        lines.append(f"  x{i}: {{plugin: analytic/normal, mean: {1 + bias + 1e-9 * i!r}, "
                     "primaries: 1}")
    lines.append("tests:")
    for i, (allow, _) in enumerate(cases()):
        margin = f", allow: {allow!r}" if allow else ""
        lines.append(f"  - {{name: '{i}', claim: mean(x{i}) == 1, detect: {DETECT!r}{margin}}}")
    return "\n".join(lines) + "\n"


def outcomes(assay, suite, seed):
    tests = tests_on_fixed_shares(assay, suite, seed)
    return [(test["verdict"], test["samples"][0]["secondaries"]) for test in tests]


def fixed_sample(allow):
    z = statistics.NormalDist().inv_cdf
    return ((z(1 - ALPHA / 2) + z(1 - BETA)) / (DETECT - allow)) ** 2


def rate(count, runs):
    low = lower_limit(count, runs, CONFIDENCE)
    high = 1 - lower_limit(runs - count, runs, CONFIDENCE)
    return f"{count / runs:.4g} ({low:.2g} to {high:.2g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()
    runs = arguments.seeds

    counts = [collections.Counter() for _ in cases()]
    observations = [0] * len(counts)
    with tempfile.TemporaryDirectory() as name:
        suite = pathlib.Path(name) / "bias.yaml"
        suite.write_text(suite_text())
        with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
            for run in pool.map(lambda seed: outcomes(arguments.assay, suite, seed),
                                range(1, runs + 1)):
                for i, (verdict, secondaries) in enumerate(run):
                    counts[i][verdict] += 1
                    observations[i] += secondaries

    print(f"{runs} runs; alpha {ALPHA:g}, beta {BETA:g}, detect {DETECT:g}")
    print("| allow | bias | fail | pass | inconclusive | observations | of fixed n |")
    print("|---|---|---|---|---|---|---|")
    wrong = []
    for i, (allow, bias) in enumerate(cases()):
        mean = observations[i] / runs
        share = mean / fixed_sample(allow)
        print(f"| {allow:g} | {bias:g} | {rate(counts[i]['fail'], runs)} | "
              f"{rate(counts[i]['pass'], runs)} | {rate(counts[i]['inconclusive'], runs)} | "
              f"{mean:.0f} | {share:.3f} |")
        mistake, level = (("fail", ALPHA) if bias <= allow else ("pass", BETA))
        if bias <= allow or bias >= DETECT:
            if lower_limit(counts[i][mistake], runs, CONFIDENCE) > level:
                wrong.append(f"allow {allow:g}, bias {bias:g}: too many {mistake}")
        target = {0: 0.25, 0.05: 0.02}.get(bias)
        if allow and target and share >= target:
            wrong.append(f"allow {allow:g}, bias {bias:g}: {share:.3f} of fixed n, not {target:g}")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
