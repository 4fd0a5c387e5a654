#!/usr/bin/env bash
# Installs what is missing, builds and runs suites. The console ends with the path of the report.
#   bash suites/run.sh [SUITE...]      default: the suites of the main case
# Exit code: that of `assay run` (0: every verdict as expected).
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

lists=(suites/packages.txt)
for suite in "$@"; do
  # A suite that needs more, such as another renderer, has a list beside it.
  if [ -e "${suite%.yaml}-packages.txt" ]; then lists+=("${suite%.yaml}-packages.txt"); fi
done
install_packages "${lists[@]}"
build_project build assay

if [ $# -eq 0 ]; then
  set -- suites/luminaire.yaml suites/luminaire-mutants.yaml suites/brdf.yaml \
    suites/brdf-mutants.yaml suites/environment.yaml
fi
mkdir -p build/report
build/harness/assay run "$@" --report console=- --report html=build/report/report.html \
  --report json=build/report/report.json --report junit=build/report/junit.xml \
  --report markdown=build/report/report.md
