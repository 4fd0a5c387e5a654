#!/usr/bin/env python3
"""Runs suites of true claims under seeds 1 to N, each suite by itself, and counts the runs in which one fails.

Only tests that are expected to pass are run. --budget caps what each may cost, so that claims which need
more than that stay undecided: a study of false alarms wants many runs, not many observations in each.
"""

import argparse
import collections
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile


def upper_tail(count, runs, probability):
    """P(Binomial(runs, probability) >= count)."""
    return sum(
        math.exp(
            math.lgamma(runs + 1) - math.lgamma(k + 1) - math.lgamma(runs - k + 1)
            + k * math.log(probability) + (runs - k) * math.log1p(-probability))
        for k in range(count, runs + 1))


def lower_limit(count, runs, confidence):
    """Clopper and Pearson's one-sided lower limit of a probability."""
    if count == 0:
        return 0.0
    low, high = 0.0, count / runs
    for _ in range(100):
        middle = (low + high) / 2
        if upper_tail(count, runs, middle) > 1 - confidence:
            high = middle
        else:
            low = middle
    return low


def record_of(assay, suites, seed, *options):
    """The record of a run on one thread."""
    command = [assay, "run", *map(str, suites), "--seed", str(seed), "--threads", "1", "--quiet",
               "--report", "json=-", *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1, 3):
        raise RuntimeError(f"seed {seed}: exit code {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def tests_on_fixed_shares(assay, suite, seed):
    """The tests of a suite. A shard, even the only one, rests on the fixed share of alpha."""
    return record_of(assay, [suite], seed, "--shard", "1/1")["suites"][0]["tests"]


def true_claims(suite, folder, budget, coarsen):
    """A copy of the suite with only the tests that are expected to pass, each within the budget, and with
    so many times fewer secondaries, at least 100, where their number is fixed: `--coarsen` leaves it.

    What stands beside it and one folder up is linked, so that its files are where it looks for them."""
    import yaml  # here, because studies that take only limits from this file run without it

    suite = pathlib.Path(suite).resolve()
    place = folder / suite.parent.name
    for original, copy in ((suite.parent.parent, folder), (suite.parent, place)):
        copy.mkdir(exist_ok=True)
        for beside in original.iterdir():
            if beside != suite.parent and beside.suffix != ".yaml" and not (copy / beside.name).exists():
                (copy / beside.name).symlink_to(beside)
    content = yaml.safe_load(suite.read_text(encoding="utf-8"))
    content.pop("statements", None)
    content["tests"] = [t for t in content["tests"] if t.get("expect", "pass") == "pass"]
    for test in content["tests"]:
        if budget and test.get("cost") != "seconds":  # which is timed on whole replicates
            test.setdefault("budget", budget)
        fixed = float(test.get("secondaries", 0))  # which YAML 1.1 reads as a text where it is 1e6
        if fixed > 100:
            test["secondaries"] = max(100, round(fixed / coarsen))
    copy = place / suite.name
    copy.write_text(yaml.safe_dump(content, sort_keys=False, width=100000), encoding="utf-8")
    return copy


def run(arguments, suite, seed):
    return record_of(arguments.assay, [suite], seed, "--alpha", str(arguments.alpha),
                     "--coarsen", str(arguments.coarsen))


def verdicts(record):
    for suite in record["suites"]:
        for test in suite["tests"]:
            yield test["id"], test["verdict"]


def study(arguments, suite, pool):
    """Prints a row of the table and which tests failed; returns whether the limit keeps below alpha."""
    failed_runs = 0
    counts = collections.Counter()
    failures = collections.Counter()
    seeds = range(1, arguments.seeds + 1)
    for record in pool.map(lambda seed: run(arguments, suite, seed), seeds):
        results = list(verdicts(record))
        counts.update(verdict for _, verdict in results)
        failed = [name for name, verdict in results if verdict == "fail"]
        failures.update(failed)
        failed_runs += bool(failed)
    limit = lower_limit(failed_runs, arguments.seeds, 0.999)
    print(f"| `{suite.name}` | {arguments.seeds} | {failed_runs} | {limit:.4f} | "
          + ", ".join(f"{n} {v}" for v, n in counts.most_common()) + " |")
    for name, count in failures.most_common(10):
        print(f"  {count:4d}  {name}")
    sys.stdout.flush()
    return limit <= arguments.alpha


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--alpha", type=float, default=0.1)
    parser.add_argument("--coarsen", type=float, default=10)
    parser.add_argument("--budget", type=float, help="primaries a test may take; none by default")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("suites", nargs="+")
    arguments = parser.parse_args()
    arguments.assay = str(pathlib.Path(arguments.assay).resolve())

    print(f"| suite | runs | that failed a true claim | exact 99.9 % lower limit (alpha {arguments.alpha}) | "
          "verdicts of true claims |\n|---|---|---|---|---|")
    with (tempfile.TemporaryDirectory() as folder,
          concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool):
        copies = [true_claims(suite, pathlib.Path(folder), arguments.budget, arguments.coarsen)
                  for suite in arguments.suites]
        kept = [study(arguments, copy, pool) for copy in copies]
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
