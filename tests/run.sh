#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test.
#   bash tests/run.sh [CTEST_OPTION...]      such as -R luminaire
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build all -- -DASSAY_TESTS=ON ${CI:+-DASSAY_WERROR=ON}
ctest --test-dir build --output-on-failure --no-tests=error -j "$(nproc)" "$@"
