#!/usr/bin/env bash
# The study of image comparisons: power, false alarms, two million samples. It takes hours at these
# counts.
#   bash tests/image_study.sh [STACKS LEVEL SAMPLES]     repetitions, default 100 20000 400
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build image_power -- -DASSAY_TESTS=ON
build/tests/bench/image_power stacks "${1:-100}"
build/tests/bench/image_power level "${2:-20000}"
build/tests/bench/image_power samples "${3:-400}"
