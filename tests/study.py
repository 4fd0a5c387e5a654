#!/usr/bin/env python3
"""Runs suites of true claims under seeds 1 to N and counts the runs in which one fails."""

import argparse
import collections
import concurrent.futures
import json
import math
import subprocess
import sys


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


def run(arguments, seed):
    return record_of(arguments.assay, arguments.suites, seed, "--alpha", str(arguments.alpha),
                     "--coarsen", str(arguments.coarsen))


def verdicts_of_true_claims(record):
    for suite in record["suites"]:
        for test in suite["tests"]:
            if test["expected"] == "pass":
                yield test["id"], test["verdict"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=400)
    parser.add_argument("--alpha", type=float, default=0.1)
    parser.add_argument("--coarsen", type=float, default=10)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("suites", nargs="+")
    arguments = parser.parse_args()

    failed_runs = 0
    verdicts = collections.Counter()
    failures = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        seeds = range(1, arguments.seeds + 1)
        for record in pool.map(lambda seed: run(arguments, seed), seeds):
            results = list(verdicts_of_true_claims(record))
            verdicts.update(verdict for _, verdict in results)
            failed = [name for name, verdict in results if verdict == "fail"]
            failures.update(failed)
            failed_runs += bool(failed)

    limit = lower_limit(failed_runs, arguments.seeds, 0.999)
    print(f"{failed_runs} of {arguments.seeds} runs failed a true claim: "
          f"{failed_runs / arguments.seeds:.4f}, exact 99.9 % lower limit {limit:.4f}, "
          f"alpha {arguments.alpha}")
    print("verdicts of true claims: " + ", ".join(f"{n} {v}" for v, n in verdicts.most_common()))
    for name, count in failures.most_common(10):
        print(f"  {count:4d}  {name}")
    return 0 if limit <= arguments.alpha else 1


if __name__ == "__main__":
    sys.exit(main())
