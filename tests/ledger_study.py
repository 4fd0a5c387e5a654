#!/usr/bin/env python3
"""Level and power of `assay run --ledger`, through the program as a user runs it.

    python3 tests/ledger_study.py --assay build/harness/assay

Suites of one test each, whose estimators differ a little in their mean and so have streams of their
own, share a ledger; every night runs them all with a fresh seed. Two studies:
  power   theta is one standard error of a night: the share of ledgers that alarm by night 30
  level   theta is 0 and the reference is off by 0.2 of a night's standard error, as it says: the
          share that alarm by night 100, against the budget of 3e-3
The exit code says whether power is at least 0.9 and the exact 99.9 % lower limit of the level does
not exceed the budget.
"""

import argparse
import json
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


def alarms(assay, count, nights, shift, spread):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = write_suites(folder, count, shift, spread)
        for night in range(1, nights + 1):
            command = [assay, "run", *map(str, files), "--seed", str(night), "--quiet", "--threads",
                       "1", "--ledger", str(folder / "n.ledger"), "--report", "json=-"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode not in (0, 1, 3):
                raise RuntimeError(f"night {night}: exit code {done.returncode}: {done.stderr}")
        series = json.loads(done.stdout)["ledger"]["series"]
        assert len(series) == count
        # A gate on a night's own data is red now and then: that night is invalid and adds nothing.
        assert sum(each["nights"] for each in series) > 0.99 * count * nights
        return sum(each["alarm"] for each in series)


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
    return 0 if found >= 0.9 * n and limit <= BUDGET else 1


if __name__ == "__main__":
    sys.exit(main())
