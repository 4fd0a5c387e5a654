#!/usr/bin/env bash
# The study of image comparisons on pictures of three scenes: false alarms of sound pairs, and the
# least defects found beside three rules of others. An hour at these counts on two cores.
#   bash tests/image_study.sh [LEVEL POWER SEED]     runs a cell, default 200 20 1
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt
build_project build picture_study -- -DASSAY_TESTS=ON
study=build/tests/bench/picture_study
seed="${3:-1}"
pairs=("light bsdf" "light multiple" "bsdf multiple" "light light" "bsdf bsdf" "multiple multiple")
defects=(light_density weight roulette clamp tile dead_pixel shadow_offset schlick)
{
  for scene in box glass plates; do
    for pictures in 16 32 64 128; do
      for pair in "${pairs[@]}"; do
        echo "level $scene $pair $pictures ${1:-200} $seed"
      done
      for defect in "${defects[@]}"; do
        echo "power $scene $defect $pictures ${2:-20} $seed"
      done
    done
  done
} | xargs -P "$(nproc)" -L 1 "$study"
