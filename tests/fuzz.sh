#!/usr/bin/env bash
# Fuzzes each target of tests/fuzz/ for a minute, with the address and undefined behaviour
# sanitizers. A find ends the run with exit code 1 and is kept in build/fuzz/.

#   bash tests/fuzz.sh [TARGET...] [-- LIBFUZZER_OPTION...]     such as: protocol -- -max_total_time=600
# A new target is tests/fuzz/NAME_fuzz.cpp with LLVMFuzzerTestOneInput(). Its first inputs stand in
# tests/fuzz/corpus/NAME/, and these lines on top:
#   // sources: FILE...      The files to link, from the root.
#   // libraries: FLAG...    Such as -lyaml-cpp, if needed.
#   // options: OPTION...    Options of libFuzzer, if needed.
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/fuzz/packages.txt

# said_in FILE WORD: what stands after `// WORD:` in a target, on all such lines.
said_in() { sed -n "s|^// $2:||p" "$1" | tr '\n' ' '; }

targets=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do targets+=("$1"); shift; done
[ "${1:-}" = -- ] && shift
if [ ${#targets[@]} -eq 0 ]; then
  for file in tests/fuzz/*_fuzz.cpp; do
    name=$(basename "$file" _fuzz.cpp)
    targets+=("$name")
  done
fi

code=0
for name in "${targets[@]}"; do
  file=tests/fuzz/${name}_fuzz.cpp
  folder=build/fuzz/$name
  mkdir -p "$folder/corpus"
  echo "$name: compiling"
  # shellcheck disable=SC2046  # one word a file
  clang++-14 -std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined \
    -I. -Iestimators "$file" $(said_in "$file" sources) $(said_in "$file" libraries) \
    -o "$folder/$name"
  echo "$name: fuzzing"
  # shellcheck disable=SC2046
  "$folder/$name" -max_total_time=60 -max_len=4096 -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$folder/" $(said_in "$file" options) "$@" \
    "$folder/corpus" "tests/fuzz/corpus/$name" >"$folder/log" 2>&1 || code=1
  if [ $code -ne 0 ]; then
    tail -n 40 "$folder/log"
    echo "$name: found something; all of it is in $folder/log"
    exit $code
  fi
  sed -n 's/^stat::number_of_executed_units: /'"$name"': nothing found; inputs tried: /p' "$folder/log"
done
