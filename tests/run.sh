#!/usr/bin/env bash
# Installs what is missing, builds everything and runs the tests.
#   bash tests/run.sh [--all] [CTEST_OPTION...]      such as -R luminaire
# --all runs long calibrations whole, not in their short forms, and all deaths of programs.
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

which=(--label-exclude '^long$')
if [ "${1-}" = --all ]; then
  which=()
  export ASSAY_LONG=1  # tests/stats/calibration.h
  shift
fi
install_packages suites/packages.txt tests/packages.txt
build_project build all -- -DASSAY_TESTS=ON ${CI:+-DASSAY_WERROR=ON}
ctest --test-dir build --output-on-failure --no-tests=error -j "$(nproc)" "${which[@]}" "$@"
