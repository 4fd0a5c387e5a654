#!/usr/bin/env python3
"""Level and power of `assay run --ledger`, through the program as a user runs it.

    python3 tests/ledger_study.py --assay build/harness/assay

Suites of one test each, whose estimators differ a little in their mean and so have streams of their
own, share a ledger; every night runs them all with a fresh seed. Three studies:
  power   theta is one standard error of a night: the share of ledgers that alarm by night 30
  level   theta is 0 and the reference is off by 0.2 of a night's standard error, as it says: the
          share that alarm by night 100, against the budget of 3e-3
  methods one suite whose claims hold, and one whose claims are off by 11 standard errors of 55
          nights, by every kind of evidence: nights until the alarm, and ln E of those that hold
The exit code says whether power is at least 0.9, the exact 99.9 % lower limit of the level does not
exceed the budget, and of the methods all that are off alarm and none that holds.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

from study import lower_limit

SECONDARIES = 100
NIGHT = SECONDARIES ** -0.5  # standard error of a night: the standard deviation is 1
BUDGET = 3e-3


def write_suites(folder, count, shift, spread):
    draw = random.Random(1)
    files = []
    for i in range(count):
        mean = 1 + 1e-6 * i
        reference = mean + NIGHT * (spread * draw.gauss(0, 1) - shift)
        files.append(folder / f"s{i}.yaml")
        files[-1].write_text(
            f"suite: s{i}\nestimators:\n  x: {{plugin: analytic/normal, mean: {mean!r}, primaries: 1}}\n"
            f"tests:\n  - {{claim: mean(x) == {reference!r} +- {spread * NIGHT!r}, "
            f"secondaries: {SECONDARIES}}}\n")
    return files


def series_after(assay, files, folder, nights):
    for night in range(1, nights + 1):
        command = [assay, "run", *map(str, files), "--seed", str(night), "--quiet", "--threads",
                   "1", "--ledger", str(folder / "n.ledger"), "--report", "json=-"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1, 3):
            raise RuntimeError(f"night {night}: exit code {done.returncode}: {done.stderr}")
    series = json.loads(done.stdout)["ledger"]["series"]
    assert all(len(each["nights"]) == nights for each in series)
    return series


def alarms(assay, count, nights, shift, spread):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        series = series_after(assay, write_suites(folder, count, shift, spread), folder, nights)
        assert len(series) == count
        return sum(each["alarm"] for each in series)


# Claims of 1000 observations, with the true number and the standard error of a night.
CLAIMS = [("mean(uniform) == {}", 0.5, 12**-0.5), ("mean(hits) == {}", 0.1, 0.3),
          ("mean(skewed) == {}", 1, 1), ("mean(normal) <= {}", 1, -1),
          ("quantile(normal, 0.5) == {}", 1, (math.pi / 2) ** 0.5),
          ("variance(normal) == {}", 1, 2**0.5),
          ("mean(normal) == {} * mean(skewed)", 1, 2**0.5),
          ("distribution(normal) == normal({}, 1)", 1, (math.pi / 2) ** 0.5)]


def methods(assay, shift, nights=55):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        suite = folder / "methods.yaml"
        lines = ["suite: methods", "estimators:"]
        for estimator, law in (("uniform", "uniform(0, 1)"), ("hits", "bernoulli(0.1)"),
                               ("skewed", "exponential(1)"), ("normal", "normal(1, 1)")):
            lines.append(f'  {estimator}: {{plugin: analytic/law, law: "{law}", primaries: 1}}')
        lines.append("tests:")
        for claim, truth, deviation in CLAIMS:
            number = truth + shift * deviation * 1000**-0.5
            lines.append(f'  - {{claim: "{claim.format(repr(number))}", secondaries: 1000}}')
        suite.write_text("\n".join(lines) + "\n")
        return series_after(assay, [suite], folder, nights)


def first_alarm(series):
    reached = [night["log_e"] >= series["limit"] for night in series["nights"]]
    return reached.index(True) + 1 if series["alarm"] else None


def study_methods(assay):
    sound = methods(assay, 0)
    wrong = methods(assay, 11 * 55**-0.5)
    for (claim, _, _), holds, off in zip(CLAIMS, sound, wrong):
        print(f"methods: {claim}: ln E {holds['nights'][-1]['log_e']:.1f} if it holds; off, alarm "
              f"after {first_alarm(off)} nights, ln E {off['nights'][-1]['log_e']:.1f}")
    return all(each["alarm"] for each in wrong) and not any(each["alarm"] for each in sound)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--ledgers", type=int, default=200)
    arguments = parser.parse_args()
    n = arguments.ledgers

    found = alarms(arguments.assay, n, nights=30, shift=1, spread=0)
    print(f"power: one standard error a night: {found} of {n} found within 30 nights", flush=True)
    false = alarms(arguments.assay, n, nights=100, shift=0, spread=0.2)
    limit = lower_limit(false, n, 0.999)
    print(f"level: {false} of {n} alarmed within 100 nights, lower limit {limit:.5f}, budget {BUDGET}")
    kept = study_methods(arguments.assay)
    return 0 if found >= 0.9 * n and limit <= BUDGET and kept else 1


if __name__ == "__main__":
    sys.exit(main())
