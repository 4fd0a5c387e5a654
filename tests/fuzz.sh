#!/usr/bin/env bash
# Fuzzes each target of tests/fuzz/ for a minute, with the address and undefined behaviour
# sanitizers. A find ends the run with exit code 1 and is kept in build/fuzz/.
#
#   bash tests/fuzz.sh [TARGET...] [-- LIBFUZZER_OPTION...]     such as: protocol -- -max_total_time=600
# A new target is tests/fuzz/NAME_fuzz.cpp with LLVMFuzzerTestOneInput(). Its first inputs stand in
# tests/fuzz/corpus/NAME/, and options of libFuzzer in a line on top, `// options: OPTION...`.
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/fuzz/packages.txt

targets=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do targets+=("$1"); shift; done
[ "${1:-}" = -- ] && shift
if [ ${#targets[@]} -eq 0 ]; then
  for file in tests/fuzz/*_fuzz.cpp; do
    name=$(basename "$file" _fuzz.cpp)
    targets+=("$name")
  done
fi

cmake -G Ninja -S . -B build/fuzz -DCMAKE_CXX_COMPILER=clang++-16 -DASSAY_FUZZ=ON -DASSAY_SANITIZE=ON \
  -DCMAKE_CXX_FLAGS='-fsanitize=fuzzer-no-link -fno-sanitize-recover=undefined -Wno-unknown-warning-option' >/dev/null
cmake --build build/fuzz --target "${targets[@]/%/_fuzz}"

code=0
for name in "${targets[@]}"; do
  folder=build/fuzz/$name
  mkdir -p "$folder/corpus"
  echo "$name: fuzzing"
  # shellcheck disable=SC2046
  "build/fuzz/tests/fuzz/${name}_fuzz" -max_total_time=60 -max_len=4096 -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$folder/" $(sed -n "s|^// options:||p" "tests/fuzz/${name}_fuzz.cpp") "$@" \
    "$folder/corpus" "tests/fuzz/corpus/$name" >"$folder/log" 2>&1 || code=1
  if [ $code -ne 0 ]; then
    tail -n 40 "$folder/log"
    echo "$name: found something; all of it is in $folder/log"
    exit $code
  fi
  sed -n 's/^stat::number_of_executed_units: /'"$name"': nothing found; inputs tried: /p' "$folder/log"
done
