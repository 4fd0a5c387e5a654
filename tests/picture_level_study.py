#!/usr/bin/env python3
"""How often a true claim on pictures fails, by their number and the law of their noise.

  python3 tests/picture_level_study.py --assay build/harness/assay [--sets 100]

Pictures of 32 x 32 pixels whose means rise from 1 to 10, each with noise of its mean times a
variable of mean 0 and variance 1, against the exact picture: what `assay images` is asked of 16 to
64 renderings and a reference.
"""
import argparse
import json
import math
import os
import random
import struct
import subprocess
import tempfile

SIDE = 32
MEANS = [1 + 9 * x / (SIDE - 1) for x in range(SIDE)]
LAWS = {
    "normal": lambda r: r.gauss(0, 1),
    "exponential": lambda r: r.expovariate(1) - 1,
    "lognormal(0, 1)": lambda r: (math.exp(r.gauss(0, 1)) - math.exp(.5)) / math.sqrt((math.e - 1) * math.e),
    "zero_inflated(0.1)": lambda r: ((r.expovariate(1) if r.random() < .1 else 0) - .1) / math.sqrt(.19),
    "bernoulli(0.01)": lambda r: ((r.random() < .01) - .01) / math.sqrt(.0099),
}
SUITE = """suite: level
alpha: 0.05
estimators:
  a: {plugin: recorded, file: 'a*.exr', pixels: independent}
  b: {plugin: recorded, file: exact.exr, exact: true}
tests:
  - claim: mean(a) == mean(b)
"""


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write_picture(path, rows):
    """One channel of floats, uncompressed scan lines."""
    box = struct.pack("<4i", 0, 0, SIDE - 1, SIDE - 1)
    head = struct.pack("<2i", 20000630, 2)
    head += attribute("channels", "chlist", b"Y\0" + struct.pack("<i4B2i", 2, 0, 0, 0, 0, 1, 1) + b"\0")
    head += attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    head += attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 4 * SIDE
    first = len(head) + 8 * SIDE
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{SIDE}Q", *(first + y * line for y in range(SIDE))))
        for y, row in enumerate(rows):
            file.write(struct.pack(f"<2i{SIDE}f", y, 4 * SIDE, *row))


def verdict(assay, folder, count, law, source):
    for i in range(count):
        write_picture(f"{folder}/a{i:03}.exr",
                      [[m * (1 + law(source)) for m in MEANS] for _ in range(SIDE)])
    subprocess.run([assay, "run", f"{folder}/level.yaml", "--report", f"json={folder}/level.json",
                    "--report", "console=/dev/null"], check=False)
    with open(f"{folder}/level.json", encoding="utf-8") as file:
        return json.load(file)["suites"][0]["tests"][0]["verdict"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--sets", type=int, default=100)
    arguments = parser.parse_args()
    assay = os.path.abspath(arguments.assay)
    print("| noise | pictures | fail | invalid |\n|---|---|---|---|")
    for name, law in LAWS.items():
        for count in (16, 24, 32, 64):
            with tempfile.TemporaryDirectory() as folder:
                write_picture(f"{folder}/exact.exr", [MEANS] * SIDE)
                with open(f"{folder}/level.yaml", "w", encoding="utf-8") as file:
                    file.write(SUITE)
                verdicts = [verdict(assay, folder, count, law, random.Random(f"{name} {count} {i}"))
                            for i in range(arguments.sets)]
            shares = [verdicts.count(each) / arguments.sets for each in ("fail", "invalid")]
            print(f"| {name} | {count} | {shares[0]:.2f} | {shares[1]:.2f} |", flush=True)


if __name__ == "__main__":
    main()
