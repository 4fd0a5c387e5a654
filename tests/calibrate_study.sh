#!/usr/bin/env bash
# The long studies of levels and sample counts: calibration of all methods, verdicts on laws of every
# shape. The calibration has 20,000 runs a cell, or RUNS. Its cells go to calibration.html and calibration.json
# here, a table of the four verdicts by method and law to calibration.md.
#   bash tests/calibrate_study.sh [RUNS]
set -euo pipefail
folder=$PWD
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build assay
runs=${1:-20000}
failed=0
build/harness/assay calibrate --runs "$runs" --report html="$folder/calibration.html" \
  --report json="$folder/calibration.json" || failed=1
/usr/bin/python3 tests/calibration_table.py "$folder/calibration.json" >"$folder/calibration.md"
/usr/bin/python3 tests/verdict_study.py --assay build/harness/assay || failed=1
exit "$failed"
