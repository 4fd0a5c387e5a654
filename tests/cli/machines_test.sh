#!/usr/bin/env bash
# Runs on many machines, and runs that are killed: each gives the record of one thread.
#   machines_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
mkdir one other

of_one_thread() {
  "$assay" run "$1" --quiet --threads 1 "${@:2}" --report json=one/run.json --report console=/dev/null \
    2>err </dev/null
  [[ $? == [013] ]] || fail "assay run $1 failed"
}
# Kills at more times and of more ranks.
long=${ASSAY_LONG-}
# Suites are run whole then. Else they leave out what takes long to prepare, and planted bugs.
part=(--filter '-*solid_angle.direction*' --filter '-*found*')
[ -z "$long" ] || part=()
same_as_of_one_thread() { diff <(timeless one/run.json) <(timeless other/run.json) >out || fail "$1: another record"; }

test_killed_runs_go_on_to_the_same_record() {
  local suite=$source_folder/tests/suites/kinds.yaml coarsen=1 kills=0 most=.1
  [ -z "$long" ] || suite=$source_folder/suites/luminaire.yaml coarsen=4 most=.4
  of_one_thread "$suite" --coarsen $coarsen
  for _ in 1 ${long:+2 3}; do
    while :; do
      timeout --signal=KILL "$(/usr/bin/python3 -c "import random; print(random.uniform(.02, $most))")" \
        "$assay" run "$suite" --coarsen $coarsen --quiet --checkpoint kept --checkpoint-every .01 \
        --report json=other/run.json --report console=/dev/null >/dev/null 2>err </dev/null
      [ $? -le 3 ] && break
      kills=$((kills + 1))
      most=$(/usr/bin/python3 -c "print($most * 1.4)")
    done
    same_as_of_one_thread "after $kills kills"
    [ -z "$(find . -name 'kept*')" ] || fail 'the checkpoint of a run that ended stays'
  done
  [ "$kills" -gt 1 ] || fail "only $kills kills"
}

test_interrupted_run_goes_on() {
  local suite=$source_folder/suites/luminaire.yaml
  of_one_thread "$suite" --coarsen 4 "${part[@]}"
  "$assay" run "$suite" --coarsen 4 "${part[@]}" --quiet --checkpoint kept --checkpoint-every .01 \
    >/dev/null 2>err </dev/null &
  until [ -s kept.kept ]; do sleep .01; done
  kill -TERM $!
  wait $!
  [ $? -eq 130 ] || fail 'not interrupted'
  contains err 'what was drawn is kept in kept and kept.kept; the same command continues'
  expect 2 run "$suite" --coarsen 4 "${part[@]}" --seed 7 --checkpoint kept
  contains err "kept: is the checkpoint of another run: the seed was the suite's and is 7; remove it, or name another file"
  "$assay" run "$suite" --coarsen 4 "${part[@]}" --quiet --checkpoint kept --report json=other/run.json >/dev/null 2>err
  same_as_of_one_thread resumed
}

test_checkpoint_cannot_be_a_report_or_a_suite() {
  local report
  for report in a a.kept; do
    expect 2 run "$source_folder/suites/luminaire.yaml" --checkpoint a --report json=$report
    contains err 'which a report would replace'
  done
  echo mine >b.kept
  expect 2 run "$source_folder/suites/luminaire.yaml" --checkpoint b
  contains err 'b.kept: was not written by Assay and would be lost; name another checkpoint'
  [ "$(cat b.kept)" = mine ] || fail 'a file of the user is lost'
  expect 2 run "$source_folder/suites/luminaire.yaml" --checkpoint "$source_folder/suites/luminaire.yaml"
  contains err 'it was not written by Assay'
}

# test_ranks_… skip where MPI is missing: ranks N ARGUMENT…
ranks() {
  timeout -k 9 100 mpirun --allow-run-as-root --oversubscribe -n "$1" "$assay" "${@:2}" >out 2>err </dev/null
}
descendants() {
  local child
  for child in $(pgrep -P "$1"); do
    echo "$child"
    descendants "$child"
  done
}
# signal_rank SIGNAL RANK JOB: to one rank of a job of this shell's.
signal_rank() {
  local process
  for process in $(descendants "$3"); do
    [ "$(readlink "/proc/$process/exe")" = "$(dirname "$(realpath "$assay")")/assay-mpi" ] || continue
    grep -qzx "OMPI_COMM_WORLD_RANK=$2" "/proc/$process/environ" || continue
    kill "-$1" "$process" && return
  done
  return 1
}
require_mpi() {
  [ -x "$(dirname "$assay")/assay-mpi" ] && command -v mpirun >/dev/null && return
  echo 'skipped: MPI is missing (libopenmpi-dev, openmpi-bin) or was when Assay was built'
  exit 77
}

test_ranks_give_the_record_of_one_process() {
  require_mpi
  local suite n counts=(3)
  [ -z "$long" ] || counts=(1 2 3 4)
  for suite in "$source_folder"/{tests/suites/kinds,suites/luminaire,suites/images,suites/analytic}.yaml; do
    of_one_thread "$suite" --coarsen 8 "${part[@]}"
    for n in "${counts[@]}"; do
      ranks "$n" run "$suite" --coarsen 8 "${part[@]}" --quiet --report json=other/run.json
      [ $? -le 3 ] || fail "$n ranks of $suite"
      same_as_of_one_thread "$n ranks of $suite"
    done
  done
}

# A rank that stops for ever, and one that is asked to end.
test_ranks_that_stall_are_done_without() {
  require_mpi
  local suite=$source_folder/suites/luminaire.yaml signal
  of_one_thread "$suite" --coarsen 3 "${part[@]}"
  for signal in STOP TERM; do
    rm -f kept kept.kept
    ranks 3 run "$suite" --coarsen 3 "${part[@]}" --quiet --checkpoint kept --checkpoint-every .01 \
      --report json=other/run.json &
    until [ "$(stat -c %s kept.kept 2>/dev/null)0" -gt 40000 ]; do sleep .01; done  # all ranks draw
    signal_rank $signal 2 $! || fail 'no rank'
    wait $!
    same_as_of_one_thread "SIG$signal"
  done
}

test_ranks_that_never_meet_end() {
  require_mpi
  [ -n "$long" ] || { echo 'skipped: it takes two minutes'; exit 77; }
  timeout 200 mpirun --allow-run-as-root --oversubscribe -n 2 "$assay" run "$source_folder/tests/suites/kinds.yaml" \
    : -n 1 sleep 400 >out 2>err </dev/null
  [ $? -eq 2 ] || fail 'ranks wait for one that does not come'
  contains err 'the ranks have not met after two minutes'
}

# A signal to rank 2, or to all of the job, at random times; then the same command goes on.
#   go_on_after COUNT SIGNAL 2|all
go_on_after() {
  local hits=0 begun=$EPOCHREALTIME job
  local arguments=(run "$source_folder/tests/suites/kinds.yaml" --quiet --checkpoint kept
                   --checkpoint-every .05 --report json=other/run.json)
  if [ -z "${whole-}" ]; then  # what a run takes
    ranks 3 "${arguments[@]}"
    whole=$(/usr/bin/python3 -c "print($EPOCHREALTIME - $begun)")
  fi
  while [ $hits -lt "$1" ]; do
    ranks 3 "${arguments[@]}" &
    job=$!
    sleep "$(/usr/bin/python3 -c "import random; print(random.uniform(0, $whole))")"
    # shellcheck disable=SC2046  # one word a process
    if [ "$3" = all ]; then kill "-$2" $(descendants $job) 2>/dev/null; else signal_rank "$2" "$3" $job; fi &&
      hits=$((hits + 1))
    wait $job
    ranks 3 "${arguments[@]}"
    [ $? -le 3 ] || fail "SIG$2 to $3, time $hits: it does not go on"
    same_as_of_one_thread "SIG$2 to $3, time $hits"
    [ -z "$(find . -name '.assay-*' -o -name 'kept*')" ] || fail "SIG$2 to $3 leaves files"
  done
}

# ASSAY_KILLS is how often rank 2 is killed, all are killed, and all are asked to end.
test_ranks_that_are_killed_go_on_from_a_checkpoint() {
  require_mpi
  local counts=(${ASSAY_KILLS-2 2 1})
  of_one_thread "$source_folder/tests/suites/kinds.yaml"
  go_on_after "${counts[0]}" KILL 2
  go_on_after "${counts[1]}" KILL all
  go_on_after "${counts[2]}" TERM all
}

test_ranks_refuse_shards_and_end_with_one_message() {
  require_mpi
  ranks 2 run "$source_folder/suites/luminaire.yaml" --shard 1/2
  [ $? -eq 2 ] || fail 'a shard of ranks'
  contains err 'ranks draw one run together, and --shard makes several: leave one out'
  ranks 2 run no-such-suite.yaml
  [ $? -eq 2 ] || fail 'no suite'
  [ "$(grep -c 'no-such-suite' err)" -eq 1 ] || fail 'more than one message'
}

test_tasks_of_a_launcher_need_the_program_that_joins_them() {
  cp "$assay" assay
  OMPI_COMM_WORLD_SIZE=3 ./assay run "$source_folder/suites/luminaire.yaml" >out 2>err
  [ $? -eq 2 ] || fail 'three whole runs'
  contains err 'a launcher started 3 tasks'
  contains err 'libopenmpi-dev'
  OMPI_COMM_WORLD_SIZE=3 ./assay list plugins >out 2>err || fail 'a list is no run'
}

"$3"
