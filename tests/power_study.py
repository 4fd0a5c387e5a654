#!/usr/bin/env python3
"""How often rows fail a claim that they break by the effect which a pass says it would find.

    /usr/bin/python3 tests/power_study.py --assay build/harness/assay [--files 300] [--seed 1] [LAW ...]

For every law and size, `--files` files of rows meet a true claim. Each pass names an effect. A new file is that much too
large, another that much too small. stats/measurements.md has the results.
"""

import argparse
import collections
import json
import math
import pathlib
import subprocess
import tempfile

import numpy

LAWS = {
    "normal": (lambda random, n: 3 + random.normal(size=n), 3.0),
    "uniform": (lambda random, n: random.uniform(size=n), 0.5),
    "exponential": (lambda random, n: random.exponential(size=n), 1.0),
    "lognormal(1)": (lambda random, n: random.lognormal(0, 1, n), math.exp(0.5)),
    "lognormal(1.5)": (lambda random, n: random.lognormal(0, 1.5, n), math.exp(1.125)),
    "4 - exponential": (lambda random, n: 4 - random.exponential(size=n), 3.0),
}


def outcome_of(assay, folder, rows, mean):
    file, record = folder / "rows.txt", folder / "record.json"
    numpy.savetxt(file, rows, fmt="%.17g")
    subprocess.run([assay, "check", f"mean(a) == {mean!r}", "--estimator", f"a=recorded,file={file}", "--quiet",
                    "--report", f"json={record}", "--report", "console=/dev/null"], check=False)
    return json.loads(record.read_text())["suites"][0]["tests"][0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--files", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("laws", nargs="*", metavar="LAW", default=list(LAWS))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        for law in options.laws:
            draw, mean = LAWS[law]
            for n in (30, 100, 1000):
                random = numpy.random.default_rng([options.seed, n, list(LAWS).index(law)])

                def judged(shift):
                    return outcome_of(options.assay, pathlib.Path(name), draw(random, n) + shift * mean, mean)

                true = [judged(0) for _ in range(options.files)]
                effects = [each["detectable"] for each in true if each["verdict"] == "pass"]
                print(law, n, dict(collections.Counter(each["verdict"] for each in true)))
                for side in (1, -1) if effects else ():
                    verdicts = collections.Counter(judged(side * effect)["verdict"] for effect in effects)
                    print("   ", "above" if side > 0 else "below", f"{numpy.median(effects):.3f}", dict(verdicts))


if __name__ == "__main__":
    main()
