#!/usr/bin/env bash
# The record of every shipped suite on ranks, beside that of one thread. Left out are Cycles and the suite of seconds.
#   ranks_study.sh ASSAY [RANKS…]      3 ranks by default. Hours for 1 2 3 4.
set -uo pipefail
assay=$(realpath "${1:?ranks_study.sh ASSAY [RANKS…]}")
ranks=("${@:2}")
root=$(realpath "$(dirname "$0")/..")
source "$root/tests/cli/program.sh" "$assay" "$root"
mkdir one other
differ=0
for suite in "$source_folder"/suites/*.yaml; do
  case $suite in */cycles.yaml | */termination-time.yaml) continue ;; esac
  "$assay" run "$suite" --quiet --threads 1 --report json=one/run.json >/dev/null 2>&1 </dev/null
  code=$?
  for n in "${ranks[@]:-3}"; do
    mpirun --allow-run-as-root --oversubscribe -n "$n" "$assay" run "$suite" --quiet \
      --report json=other/run.json >/dev/null 2>err </dev/null
    if [ $? -eq $code ] && diff <(timeless one/run.json) <(timeless other/run.json) >out &&
      diff -r one other --exclude run.json >out; then
      echo "$(basename "$suite" .yaml): $n ranks, the same record"
    else
      echo "$(basename "$suite" .yaml): $n ranks, ANOTHER RECORD"
      head -5 err out
      differ=1
    fi
    rm -rf other/*
  done
  rm -rf one/*
done
exit $differ
