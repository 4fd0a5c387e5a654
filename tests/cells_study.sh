#!/usr/bin/env bash
# Power lost to large cells (tests/bench/cells_power.cpp); it takes a minute.
#   bash tests/cells_study.sh
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build cells_power -- -DASSAY_TESTS=ON
build/tests/bench/cells_power
