#!/usr/bin/env bash
# The long study of false alarms: suites of true claims, coarsened, under many seeds. At most a
# share alpha of the runs may fail. The exit code says if the exact 99.9 % lower limit of that share
# stays below alpha, for each suite.

#   bash tests/study.sh [SEEDS [SUITE...]]      400 seeds of suites/luminaire.yaml at alpha 0.1
#   bash tests/study.sh sound [SEEDS]           200 seeds of every sound suite at alpha 0.05
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build assay
study() { /usr/bin/python3 tests/study.py --assay build/harness/assay --coarsen 10 "$@"; }
if [ "${1:-}" = sound ]; then
  mapfile -t suites < <(ls suites/*.yaml | grep -v -e mutants -e zoo -e cycles)
  study --seeds "${2:-200}" --alpha 0.05 --budget 1e6 "${suites[@]}"
  exit
fi
seeds=${1:-400}
[ $# -gt 0 ] && shift
[ $# -eq 0 ] && set -- suites/luminaire.yaml
study --seeds "$seeds" --alpha 0.1 "$@"
