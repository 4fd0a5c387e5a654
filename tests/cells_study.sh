#!/usr/bin/env bash
# What the largest share of a density's mass in a cell costs in power (tests/bench/cells_power.cpp):
# a minute; the result stands in stats/README.md.
#   bash tests/cells_study.sh
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build cells_power -- -DASSAY_TESTS=ON
build/tests/bench/cells_power
