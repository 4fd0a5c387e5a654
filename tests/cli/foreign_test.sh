#!/usr/bin/env bash
# Estimators of other programs, through the program itself: verdicts, exit codes, replay, isolation.
# Runs in a temporary folder of its own, and leaves no process behind. TEST is one of the functions
# test_… below.
#   foreign_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
source "$(dirname "$0")/foreign.sh"
examples=$source_folder/estimators/foreign/examples

# library NAME BODY_OF_SECONDARY
library() {
  printf '%s\n' '#include "plugin_abi.h"' "${3:-}" "static int secondary(AssayCall *call) {" "$2" "}" \
    'static const AssayChannel x = {.size = sizeof x, .name = "x"};' \
    'static const AssayEstimator mine = {.size = sizeof mine, .name = "mine", .channels = &x,' \
    '    .channel_count = 1, .secondary = secondary};' \
    'static const AssayLibrary table = {sizeof table, ASSAY_ABI_VERSION, &mine, 1};' \
    'const AssayLibrary *assay_library(void) { return &table; }' >"$1.c"
  compile "$1.c" "${4:-}"
}

# suite FILE ESTIMATOR_LINE...: each with a test of its own, and a sound one.
suite() {
  local file=$1 line name
  shift
  {
    printf '%s\n' 'suite: foreign' 'estimators:' '  sound: {plugin: analytic/normal}'
    printf '  %s\n' "$@"
    printf '%s\n' 'tests:' '  - {name: sound, claim: mean(sound) == 0}'
    for line in "$@"; do
      name=${line%%:*}
      printf '  - {name: "%s", claim: mean(%s) == 3.141592653589793, secondaries: 200}\n' \
        "$name" "$name"
    done
  } >"$file"
}

test_examples_pass_their_claims() {
  cp "$examples"/* .
  compile darts_library.c
  suite darts.yaml 'shell: {plugin: process, command: [sh, darts.sh], primaries: 16}' \
    'python: {plugin: process, command: [/usr/bin/python3, darts.py]}' \
    'c: {plugin: process, command: [sh, compile_and_run.sh, darts.c]}' \
    'isolated: {plugin: library, file: darts_library.so}' \
    'inside: {plugin: library, file: darts_library.so, isolated: false}'
  expect 0 run darts.yaml --report json=one.json --threads 1
  expect 0 run darts.yaml --report json=two.json --threads 2
  same_records one.json two.json || fail 'threads change the record'
  for name in shell python c isolated inside; do
    expect 0 replay one.json "darts/$name"
    tells out 'the same numbers as recorded'
    expect 0 replay one.json "darts/$name" 17
    tells out 'lies in ['
  done
  none_left
}

test_isolated_draws_the_bits_of_in_process() {
  cp "$examples/darts_library.c" .
  compile darts_library.c
  expect 0 sample a --estimator a=library,file=darts_library.so --primaries 64 --secondaries 300
  tail -n +2 out >isolated.txt
  expect 0 sample a --estimator a=library,file=darts_library.so,isolated=false --primaries 64 \
    --secondaries 300
  cmp isolated.txt <(tail -n +2 out) || fail 'the numbers differ'
  [ "$(wc -l <isolated.txt)" -gt 300 ] || fail 'too few numbers'
}

test_libraries_that_fail_are_errors_and_the_others_finish() {
  local at='if (call->random->counter[2] == 37)'
  library crashes "$at { *(volatile int *)0 = 1; } call->out[0] = 3; return 0;"
  library hangs "$at { for (volatile int i = 0;; ++i) {} } call->out[0] = 3; return 0;"
  library writes_nan "call->out[0] = call->random->counter[2] == 37 ? 0.0 / (double)(call->primaries - 1) : 3; return 0;"
  library reports "$at { call->message[0] = '?'; call->message[1] = 0; return 4; } call->out[0] = 3; return 0;"
  library prints "$at { puts(\"37 it is\"); } call->out[0] = 3; return 0;" '#include <stdio.h>' ' '
  library exits "$at { _Exit(0); } call->out[0] = 3; return 0;" '#include <stdlib.h>' ' '
  suite bad.yaml 'crashes: {plugin: library, file: crashes.so, primaries: 1}' \
    'hangs: {plugin: library, file: hangs.so, primaries: 1, timeout: 0.5}' \
    'writes_nan: {plugin: library, file: writes_nan.so, primaries: 1}' \
    'reports: {plugin: library, file: reports.so, primaries: 1}' \
    'prints: {plugin: library, file: prints.so, primaries: 1}' \
    'exits: {plugin: library, file: exits.so, primaries: 1}'
  expect 1 run bad.yaml --report json=run.json
  local name
  [ "$(verdicts run.json | head -n 1)" = 'sound pass' ] || fail 'the sound one did not pass'
  for name in crashes hangs writes_nan reports prints exits; do
    [ "$(verdicts run.json | grep "^$name ")" = "$name error" ] || fail "$name is no error"
    message run.json "$name"
    tells err 'observation 37'
  done
  message run.json crashes
  tells err 'was ended by signal 11 (Segmentation fault)'
  message run.json hangs
  tells err 'within 0.5 seconds'
  message run.json reports
  tells err '? (status 4 of secondary())'
  message run.json prints
  tells err 'the library printed `37 it is` to standard output'
  none_left
}

test_programs_that_fail_are_errors_and_the_others_finish() {
  local hello="printf 'assay 1 text\\nchannel x\\nready\\n'"
  printf '%s\n' "$hello" 'read -r q; echo gone >&2; exit 3' >exits.sh
  printf '%s\n' "$hello" 'read -r q; kill -KILL $$' >killed.sh
  printf '%s\n' "$hello" 'read -r q; sleep 765432' >hangs.sh
  printf '%s\n' "$hello" 'while read -r q; do echo "$q"; done' >short.sh
  printf '%s\n' "$hello" 'n=0; while read -r q; do set -- $q; i=0; while [ $i -lt $4 ]; do
    n=$((n + 1)); echo $n; i=$((i + 1)); done; echo "$q"; done' >counts.sh
  suite bad.yaml 'exits: {plugin: process, command: [sh, exits.sh]}' \
    'killed: {plugin: process, command: [sh, killed.sh]}' \
    'hangs: {plugin: process, command: [sh, hangs.sh], timeout: 0.5}' \
    'short: {plugin: process, command: [sh, short.sh]}' \
    'counts: {plugin: process, command: [sh, counts.sh]}'
  expect 1 run bad.yaml --report json=run.json
  local name
  [ "$(verdicts run.json | head -n 1)" = 'sound pass' ] || fail 'the sound one did not pass'
  for name in exits killed hangs short counts; do
    [ "$(verdicts run.json | grep "^$name ")" = "$name error" ] || fail "$name is no error"
    message run.json "$name"
    tells err 'observation 0'
  done
  message run.json exits
  tells err 'exit status 3'
  tells err 'gone'
  message run.json counts
  tells err 'a function of key and index'
  none_left
}

test_seeds_that_do_nothing_are_errors_under_every_seed() {
  local served='assay.serve(area,' seed estimator mean='sum(area(rng) for _ in range(primaries)) / primaries'
  grep -qF "$served" "$examples/darts.py" || fail 'the example has changed'
  for seed in '' rng.index; do
    sed "s|$served|assay.serve(lambda rng, primaries: (rng.seed($seed), $mean)[1], averages=True,|" \
      "$examples/darts.py" >"${seed:+index}.py"
  done
  mv .py unseeded.py
  for seed in 1 2 3 4 5; do
    for estimator in unseeded index; do
      expect 1 check 'mean(mine) == 3.14159' --detect 1% --seed "$seed" \
        --estimator "mine=process,command=[/usr/bin/python3, $estimator.py]"
      tells out '✗ error: check/mean(mine) == 3.14159'
    done
    tells out 'gave the same numbers for two keys'
  done
  none_left
}

test_seeds_of_libraries_that_do_nothing_are_errors() {
  # Zeros and ones.
  library index 'AssayStream mine = assay_stream(5, call->random->counter[2]);
    call->out[0] = assay_uniform(&mine) < 0.2; return 0;'
  library unseeded 'static unsigned state = 1; state = state * 1664525u + 1013904223u;
    call->out[0] = state >> 31; return 0;'
  suite seeds.yaml 'index: {plugin: library, file: index.so}' \
    'index_inside: {plugin: library, file: index.so, isolated: false}' \
    'unseeded: {plugin: library, file: unseeded.so}' \
    'unseeded_inside: {plugin: library, file: unseeded.so, isolated: false}'
  expect 1 run seeds.yaml --report json=run.json
  verdict_is run.json sound pass
  for name in index index_inside unseeded unseeded_inside; do
    verdict_is run.json "$name" error
  done
}

test_a_program_that_says_no_hello_is_an_error_of_its_tests() {
  suite silent.yaml 'ended: {plugin: process, command: [sh, none.sh]}' \
    'greets: {plugin: process, command: [echo, hello]}' 'quiet: {plugin: process, command: ["true"]}'
  expect 1 run silent.yaml --report json=run.json
  verdict_is run.json sound pass
  for name in ended greets quiet; do verdict_is run.json "$name" error; done
  message run.json ended
  tells err '`ended` cannot be prepared: `sh none.sh` ended with exit status'
  tells err 'before it printed the line `ready`'
  lacks err 'assay.serve'
  message run.json quiet
  tells err 'a Python program ends with `assay.serve(FUNCTION)`'
  message run.json greets
  tells err 'the first line is `assay 1 text`'
  expect 1 check 'mean(x) == 1' --estimator 'x=process,command=[seq, 9]'
  tells out '--estimator x=recorded,file=-`'
  echo "echo \"No module named 'assay'\" >&2" >lacks.sh
  expect 1 check 'mean(x) == 1' --estimator 'x=process,command=[sh, lacks.sh]'
  tells out 'PYTHONPATH needs'
  printf "printf 'assay 1 text\\nchannel x\\nready\\n'; read -r q\n" >plain.sh
  expect 2 check 'distribution(x.line) == uniform(0, 1)' --estimator 'x=process,command=[sh, plain.sh]'
  tells err '`x` has no sampler whose draws could be tested; it has `x`; the program declares one: by `samplers=[…]`'
  printf '%s\n' 'suite: dead' 'estimators: {ended: {plugin: process, command: [sh, none.sh]}}' \
    'tests: [{claim: mean(ended) == 1}, {claim: variance(ended) <= 1}]' >dead.yaml
  expect 1 run dead.yaml --report json=run.json
  tells out 'the same error as `dead/mean(ended) == 1`'
  [ "$(grep -c 'cannot be prepared' out)" -eq 1 ] || fail 'an error is told twice'
  expect 0 report run.json
  tells out 'the same error as `dead/mean(ended) == 1`'
  [ "$(grep -c 'cannot be prepared' out)" -eq 1 ] || fail 'a saved error is told twice'
  message run.json 'variance(ended) <= 1'
  tells err '`ended` cannot be prepared'
  none_left
}

test_a_program_that_does_not_flush_is_asked_whether_it_does() {
  printf '%s\n' 'import sys' 'print("assay 1 text\nchannel x\nready")' 'sys.stdin.readline()' >mine.py
  suite silent.yaml 'mine: {plugin: process, command: [/usr/bin/python3, mine.py], timeout: 4}'
  PYTHONUNBUFFERED= "$assay" run silent.yaml >out 2>err
  tells err 'assay: `/usr/bin/python3 mine.py` has not replied for 3 s; does it flush its output (print(..., flush=True))?'
  [ "$(grep -c 'has not replied' err)" -eq 1 ] || fail 'it was asked more than once'
}

test_mistakes_are_2_before_anything_is_sampled() {
  library other 'call->out[0] = 1; return 0;'
  sed 's/ASSAY_ABI_VERSION/7/' other.c >version.c
  compile version.c
  printf 'int nothing(void);\nint nothing(void) { return 0; }\n' >symbol.c
  compile symbol.c
  library loud 'call->out[0] = 1; return 0;' '#include <stdio.h>
__attribute__((constructor)) static void greet(void) { puts("welcome"); }' ' '
  local line
  echo 1 >one.txt
  while IFS='|' read -r line wanted; do
    suite bad.yaml "mine: {$line}"
    expect 2 run bad.yaml
    tells err 'bad.yaml:4:'
    tells err "$wanted"
    [ ! -s out ] || fail 'something was printed'
  done <<'LINES'
plugin: library, file: none.so|cannot be opened: No such file or directory
plugin: library, file: bad.yaml|is no shared library
plugin: library, file: symbol.so|does not export assay_library()
plugin: library, file: version.so|was compiled for version 7 of the interface
plugin: library, file: other.so, estimator: mien|did you mean `mine`
plugin: library, estimator: mien, file: other.so|bad.yaml:4:50: library: parameter `file` starts
plugin: library, file: other.so, parameters: {rate: 2}|has no parameter `rate`
plugin: library, file: loud.so|the library printed `welcome`
plugin: process, command: [no_such_program]|cannot be started: No such file or directory
plugin: process, command: [./one.txt]|in the suite's folder: `chmod +x ./one.txt`
plugin: process, command: python3 a.py|must be a list of texts: `[python3, a.py]`
plugin: process, command: [sh, none.sh], timeout: 0|must be above 0
plugin: command, command: [cp, one.txt, "{out}", "{seed}"], output: text, depends: [no.txt]|parameter `depends` cannot be used: there is no file `no.txt`
plugin: command, command: [cp, one.txt, "{out}", "{seed}"], output: text, cache: one.txt|parameter `cache` cannot be used: the folder
LINES
  none_left
}

# Also where a batch system or a closed terminal ends the run.
test_interruption_ends_a_wait_for_a_program() {
  for signal in INT TERM HUP; do
    interrupt_by "$signal"
  done
}

interrupt_by() {
  printf '%s\n' "printf 'assay 1 text\\nchannel x\\nready\\n'" 'read -r q; sleep 765433' >hangs.sh
  suite hangs.yaml 'hangs: {plugin: process, command: [sh, hangs.sh]}'
  set -m
  "$assay" run hangs.yaml >out 2>err &
  local process=$!
  sleep 1
  kill -"$1" "$process"
  local code=0
  wait "$process" || code=$?
  [ "$code" -eq 130 ] || fail "ended with $code, not 130, by SIG$1"
  none_left
}

interrupt_stuck() {
  rm -f pilot waits
  "$assay" run stuck.yaml --report json=run.json --report console=- "$@" >out 2>err &
  until [ -e waits ]; do kill -0 $! || fail 'it ended'; sleep .05; done
  sleep .5
  kill -TERM $!
  wait $!
  [ $? -eq 130 ] || fail 'not interrupted'
}

test_an_interrupted_run_reports_the_verdicts_there_are() {
  # It answers the pilot's stream, the first, and the first looks of another.
  cat >stuck.py <<'END'
import os, random, sys, time
print("assay 1 text\nchannel x\nready", flush=True)
for line in sys.stdin:
    high, low, first, count, primaries = line.split()
    stream = f"{high}-{low}"
    try:
        os.symlink(stream, "pilot")
    except FileExistsError:
        pass
    if os.readlink("pilot") != stream and int(first) >= 10000:
        open("waits", "w").close()
        time.sleep(765433)
    for i in range(int(first), int(first) + int(count)):
        print(random.Random(f"{stream}-{i}").random())
    print(line, end="", flush=True)
END
  suite stuck.yaml 'stuck: {plugin: process, command: [python3, stuck.py]}'
  sed -i 's/== 3.*/== 0.5, detect: 0.3%, secondaries: 20000}/' stuck.yaml
  interrupt_stuck --shard 1/1
  contains err 'interrupted; no report is written'
  [ ! -e run.json ] || fail 'a shard would be merged as if it were whole'
  interrupt_stuck
  contains out 'the run was interrupted before its verdict'
  /usr/bin/python3 - run.json <<'END' || fail 'the record is another'
import json, sys
tests = json.load(open(sys.argv[1]))["suites"][0]["tests"]
assert [(each["name"], each["verdict"]) for each in tests] == [
    ("sound", "pass"), ("stuck", "skipped")], tests
END
  none_left
}

test_a_value_outside_of_its_declared_range_is_an_error() {
  # Every hundredth observation lies beyond the range.
  cat >beyond.sh <<'END'
printf 'assay 1 text\nchannel x low 0 high 3\nready\n'
while read -r high low first count primaries; do
  i=$first
  while [ "$i" -lt $((first + count)) ]; do
    echo "$((i % 100 == 99 ? 3 : low * (i + 7) / 64 % 3)).5"; i=$((i + 1))
  done
  echo "$high $low $first $count $primaries"
done
END
  suite beyond.yaml 'beyond: {plugin: process, command: [sh, beyond.sh]}'
  expect 1 run beyond.yaml
  tells out 'gave 3.5 in its channel `x`, 0.5 above 3, which it declares to be its `high`'
}

test_of_means_single_primaries_show_a_value_outside_of_the_declared_range() {
  # The mean of the hundred primaries that a secondary averages is 1.01 or 1.02.
  cat >rare.sh <<'END'
printf 'assay 1 text\nchannel x low 0 high 3\naverages\nready\n'
while read -r high low first count primaries; do
  i=$first
  while [ "$i" -lt $((first + count)) ]; do
    if [ "$primaries" -gt 1 ]; then echo "1.0$((1 + (i + low) % 2))"; else echo "$((i % 100 == 99 ? 4 : 1))"; fi
    i=$((i + 1))
  done
  echo "$high $low $first $count $primaries"
done
END
  suite rare.yaml 'rare: {plugin: process, command: [sh, rare.sh], primaries: 100}'
  expect 1 run rare.yaml
  tells out 'gave 4 in its channel `x`, 1 above 3, which it declares to be its `high`'
}

test_a_renderer_that_no_test_names_is_asked_for_its_size_alone() {
  echo 'echo start >>starts; echo 1 >$2' >render.sh
  printf '%s\n' 'suite: idle' 'estimators:' '  sound: {plugin: analytic/normal}' \
    '  idle: {plugin: command, command: [sh, render.sh, "{seed}", "{out}"], output: text}' \
    'tests:' '  - claim: mean(sound) == 0' >idle.yaml
  expect 0 run idle.yaml
  [ "$(wc -l <starts)" -eq 1 ] || fail "$(wc -l <starts) starts"
}

test_seconds_of_kept_files_are_refused() {
  echo 'echo 1 >$2' >render.sh
  printf '%s\n' 'suite: kept' 'estimators:' \
    '  kept: {plugin: command, command: [sh, render.sh, "{seed}", "{out}"], output: text}' \
    'tests:' '  - {claim: efficiency(kept) > 1, cost: seconds}' >kept.yaml
  expect 2 run kept.yaml
  tells err '`kept` is read, maybe from an earlier run'
}

test_a_library_does_not_outlive_the_run() {
  library hangs 'for (volatile int i = 0;; ++i) {} call->out[0] = 3; return 0;'
  suite hangs.yaml 'hangs: {plugin: library, file: hangs.so, primaries: 1}'
  set -m
  "$assay" run hangs.yaml >out 2>err &
  local process=$!
  sleep 1
  kill -KILL "$process"
  wait "$process" 2>/dev/null
  sleep 2
  none_left
}

test_manuals_tell_all() {
  expect 0 describe command
  contains out 'jobs: count, [0, 1024]'
  expect 0 describe process
  tells out 'assay 1 text'
  tells out 'timeout: number, (0, 1000000], s, default 60'
  expect 0 describe library
  tells out 'gcc -std=c11 -O2 -fPIC -shared'
  tells out 'its crash ends the whole run'
}

# Once for a block of observations, and once for the one that hangs.
test_a_program_that_hangs_is_waited_for_twice() {
  cat >hangs.py <<'PROGRAM'
import random, sys, time

print("assay 1 text\nchannel v\naverages\nready", flush=True)
for line in sys.stdin:
    first, count = map(int, line.split()[2:4])
    for index in range(first, first + count):
        if index == 600:
            print("waits", file=open("waits", "a"))
            time.sleep(60)
        print(random.Random(line.split()[1] + str(index)).random())
    print(line, end="", flush=True)
PROGRAM
  cat >hangs.yaml <<'SUITE'
suite: hangs
estimators:
  a: {plugin: process, command: [/usr/bin/python3, -I, hangs.py], timeout: 2}
tests:
  - claim: mean(a) == 0.5
SUITE
  expect 1 run hangs.yaml
  tells out 'did not answer for observation 600 within 2 seconds'
  [ "$(wc -l <waits)" = 2 ] || fail "$(wc -l <waits) waits"
}

test_a_program_that_hangs_once_is_examined_all_the_same() {
  cat >once.py <<'PROGRAM'
import os, random, sys, time

print("assay 1 text\nchannel v\nready", flush=True)
for line in sys.stdin:
    first, count = map(int, line.split()[2:4])
    if count > 1 and not os.path.exists("waited"):
        open("waited", "w").close()
        time.sleep(60)
    for index in range(first, first + count):
        print(random.Random(index).random())
    print(line, end="", flush=True)
PROGRAM
  expect 1 check 'mean(mine) == 0.5' \
    --estimator 'mine=process,command=[/usr/bin/python3, -I, once.py],timeout=2'
  [ -e waited ] || fail 'it never hung'
  tells out 'gave the same numbers for two keys'
}

# Either budget let the pilots and the first look make 16,384 calls each.
test_budgets_bound_what_a_program_draws() {
  cat >count.py <<'END'
import os
import time

import assay

calls = os.open("calls", os.O_WRONLY | os.O_APPEND | os.O_CREAT)


def mine(rng):
    os.write(calls, b".")
    end = time.process_time() + 0.001
    while time.process_time() < end:
        pass
    return rng.random()


assay.serve(mine)
END
  local budget
  for budget in 300 0.5s; do
    rm -f calls
    expect 3 check 'mean(m) == 0.5' --detect 2% --budget $budget \
      --estimator 'm=process,command=[/usr/bin/python3, count.py]'
    [ "$(stat -c %s calls)" -lt 3000 ] || fail "$(stat -c %s calls) calls for a budget of $budget"
    [ "$budget" != 300 ] || [ "$(tr -d '\n' <out | grep -oE '`--budget [0-9]+' | grep -oE '[0-9]+')" -gt 300 ] ||
      fail 'the advice is less than the budget'
  done
}

"$3"
