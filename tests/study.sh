#!/usr/bin/env bash
# The long study of false alarms: suites of true claims, coarsened, under many seeds.
#   bash tests/study.sh [SEEDS [SUITE...]]      default: 400 seeds of suites/luminaire.yaml
# At alpha 0.1 at most a tenth of the runs may fail; the exit code says whether the exact 99.9 % lower
# limit of the share stays below. Results stand in harness/README.md.
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build assay
seeds=${1:-400}
[ $# -gt 0 ] && shift
[ $# -eq 0 ] && set -- suites/luminaire.yaml
python3 tests/study.py --assay build/harness/assay --seeds "$seeds" --alpha 0.1 --coarsen 10 "$@"
