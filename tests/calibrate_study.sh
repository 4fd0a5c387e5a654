#!/usr/bin/env bash
# The long studies of levels and sample counts. Last results: harness/README.md.
#   bash tests/calibrate_study.sh            calibration of all methods (20,000 runs a cell), spikes, biases
#   bash tests/calibrate_study.sh RUNS       the calibration with RUNS a cell instead
# The calibration's cells, drawn and in tables, go to calibration.html and calibration.json here.
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
/usr/bin/python3 tests/spike_study.py --assay build/harness/assay || failed=1
python3 tests/bias_study.py --assay build/harness/assay || failed=1
exit "$failed"
