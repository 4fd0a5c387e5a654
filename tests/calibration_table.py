#!/usr/bin/env python3
"""The four verdicts of a calibration by method and law, as a Markdown table.

    /usr/bin/python3 tests/calibration_table.py calibration.json [--alpha 0.01]

The file comes from `assay calibrate --report json=calibration.json`. A row pools the questions of a method on a law.
Each number is a share of the runs: pass, fail, inconclusive, invalid.
"""

import argparse
import collections
import json

VERDICTS = ("pass", "fail", "inconclusive", "invalid")


def shares(cells, claim):
    runs = sum(cell[claim]["pass"]["runs"] for cell in cells)
    if runs == 0:
        return ""
    return ", ".join(f"{sum(cell[claim][verdict]['count'] for cell in cells) / runs:.2g}" for verdict in VERDICTS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("--alpha", type=float, default=0.01)
    arguments = parser.parse_args()
    with open(arguments.file, encoding="utf-8") as file:
        calibration = json.load(file)
    rows = collections.defaultdict(list)
    for cell in calibration["cells"]:
        if cell["alpha"] == arguments.alpha and cell["holds"]["pass"]["runs"] > 0:
            rows[cell["method"], cell["law"]].append(cell)
    print("| method | law | runs | claim holds | claim off by `detect` |\n|---|---|---|---|---|")
    for (method, law), cells in rows.items():
        runs = sum(cell["holds"]["pass"]["runs"] for cell in cells)
        print(f"| `{method}` | {law} | {runs} | {shares(cells, 'holds')} | {shares(cells, 'off')} |")


if __name__ == "__main__":
    main()
