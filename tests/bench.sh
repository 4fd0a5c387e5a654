#!/usr/bin/env bash
# Benchmarks, for a machine that does nothing else. Each line names what it times.

#   bash tests/bench.sh            engine, rays, KS, images, pictures, p-values, other programs
#   bash tests/bench.sh build      a clean build, and the rebuild after touching an estimator
#   bash tests/bench.sh suites     the engine's own time in every suite (some minutes)
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
if [ "${1:-}" = build ]; then
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  export CCACHE_DISABLE=1
  cmake -G Ninja -S . -B "$folder" -DASSAY_TESTS=ON -DCMAKE_CXX_COMPILER_LAUNCHER= >/dev/null
  echo "clean build of assay, without ccache:"
  time cmake --build "$folder" --target assay >/dev/null
  echo "the tests after it:"
  time cmake --build "$folder" >/dev/null
  touch estimators/luminaire/area.cpp
  echo "rebuild of assay after touching one estimator:"
  time cmake --build "$folder" --target assay >/dev/null
  exit
fi
if [ "${1:-}" = suites ]; then
  build_project build looks_bench -- -DASSAY_TESTS=ON
  for suite in suites/*.yaml; do build/tests/bench/looks_bench "$suite"; done
  exit
fi
build_project build assay foreign_bench engine_bench ks_bench rays_bench image_bench tails_bench \
  looks_bench boundary_bench pictures_bench -- -DASSAY_TESTS=ON
build/tests/bench/engine_bench
build/tests/estimators/rays_bench
build/tests/bench/ks_bench
build/tests/bench/image_bench
build/tests/bench/pictures_bench build/harness/assay
build/tests/bench/tails_bench
build/tests/bench/boundary_bench
build/tests/bench/foreign_bench estimators/foreign/examples estimators build/harness/assay
build/tests/bench/looks_bench suites/analytic.yaml suites/luminaire.yaml suites/brdf.yaml
# The same with scipy, where that is installed.
if /usr/bin/python3 -c 'import scipy' 2>/dev/null; then
  OMP_NUM_THREADS=1 /usr/bin/python3 tests/bench/image_scipy.py
  OMP_NUM_THREADS=1 /usr/bin/python3 tests/bench/tails_scipy.py
fi
