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
# Node's own packages bring npm with them; Debian's do not.
if ! command -v npm >/dev/null; then install_packages tests/viewer/packages.txt; fi
# The viewer's bundle is committed; its tests rebuild it and open the page.
if [ reports/viewer/package-lock.json -nt reports/viewer/node_modules/.package-lock.json ]; then
  npm --prefix reports/viewer ci --no-audit --no-fund --loglevel=error
fi
build_project build all -- -DASSAY_TESTS=ON ${CI:+-DASSAY_WERROR=ON}
# Programs of the distribution come first: the shim of a version manager starts much later.
PATH=/usr/bin:/bin:$PATH ctest --test-dir build --output-on-failure --no-tests=error -j "$(($(nproc) + 2))" "${which[@]}" "$@"
