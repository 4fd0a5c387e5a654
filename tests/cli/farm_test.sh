#!/usr/bin/env bash
# A renderer that fails now and then, and renders that a farm makes. TEST is one of the functions
# test_… below.
#   farm_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
source "$(dirname "$0")/foreign.sh"

# A suite of 100 renders: one to learn the size, 32 of the pilot, 67 of the test. The renderer notes
# each start in `starts` and makes a picture of noise with mean 0.5 from its seed. Every tenth start
# up to the 70th fails with half a file, so that seven renders fail once.
farm() {
  cat >render.py <<'PROGRAM'
import fcntl, os, random, struct, sys

seed, samples, out = sys.argv[1:]
with open("starts", "a+") as starts:
    fcntl.flock(starts, fcntl.LOCK_EX)
    starts.seek(0)
    number = len(starts.readlines()) + 1
    print(seed, file=starts, flush=True)
if os.path.exists("fails") and number % 10 == 0 and number <= 70:
    open(out, "w").write("half")
    sys.exit(f"node {number} is down")


def attribute(name, kind, data):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data


side, rng = 4, random.Random(int(seed))
box = struct.pack("<4i", 0, 0, side - 1, side - 1)
head = struct.pack("<2i", 20000630, 2)
head += attribute(b"channels", b"chlist", b"Y\0" + struct.pack("<i4B2i", 2, 0, 0, 0, 0, 1, 1) + b"\0")
head += attribute(b"compression", b"compression", b"\0")
head += attribute(b"dataWindow", b"box2i", box) + attribute(b"displayWindow", b"box2i", box)
head += attribute(b"lineOrder", b"lineOrder", b"\0")
head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
head += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
first, line = len(head) + 8 * side, 8 + 4 * side
with open(out, "wb") as file:
    file.write(head + struct.pack(f"<{side}Q", *(first + y * line for y in range(side))))
    for y in range(side):
        file.write(struct.pack(f"<2i{side}f", y, 4 * side, *(rng.random() for _ in range(side))))
PROGRAM
  cat >farm.yaml <<'SUITE'
suite: farm
estimators:
  mine:
    plugin: command
    command: [/usr/bin/python3, -IS, render.py, "{seed}", "{samples}", "{out}"]
    primaries: 4096
    retries: 1
tests:
  - {claim: mean(mine.average) == 0.5, secondaries: 67}
SUITE
}
pictures() { find .assay-cache -name '*.exr' ! -name 'part-*' | wc -l; }

test_renders_that_fail_are_retried_and_each_retry_is_named() {
  farm
  expect 0 run farm.yaml --report json=sound.json
  [ "$(wc -l <starts)" = 100 ] || fail "$(wc -l <starts) starts"
  rm -r .assay-cache starts
  touch fails
  expect 0 run farm.yaml -vv --report json=run.json --report console=-
  [ "$(wc -l <starts)" = 107 ] || fail "$(wc -l <starts) starts"
  [ "$(pictures)" = 100 ] || fail "$(pictures) pictures"
  # The renderer and the record agree on what failed.
  sed -n '10~10{p;70q}' starts | sort >failed
  jq -r '.suites[0].retries[] | .seed' run.json | sort | cmp -s failed || fail 'other retries'
  [ "$(jq -c '[.suites[0].retries[] | .estimator, .retry] | unique' run.json)" = '[1,"mine"]' ] ||
    fail 'other retries'
  jq -r '.suites[0].retries[].reason' run.json >reasons
  [ "$(grep -c 'exit status 1; its standard error ends with: node [1-7]0 is down' reasons)" = 7 ] ||
    fail 'other reasons'
  while read -r seed; do tells out "seed $seed of \`mine\`"; done <failed
  tells out '7 programs failed and were started again: seed '
  # No observation is another.
  same_tests sound.json run.json || fail 'retries change the numbers'
  expect 0 run farm.yaml --report json=again.json
  [ "$(wc -l <starts)" = 107 ] || fail 'a picture is made twice'
  [ "$(jq '.suites[0].retries | length' again.json)" = 0 ] || fail 'retries of another run'
  none_left
}

same_tests() { diff <(tests_of "$1") <(tests_of "$2") >err; }
tests_of() { jq 'del(.. | .seconds?) | .suites[0].tests' "$1"; }

test_a_renderer_that_fails_more_often_than_it_may_is_an_error() {
  farm
  touch fails
  sed -i 's/    retries: 1//' farm.yaml
  expect 1 run farm.yaml --report json=run.json
  verdict_is run.json 'mean(mine.average) == 0.5' error
  message run.json 'mean(mine.average) == 0.5'
  tells err 'its standard error ends with: node '  # which start comes tenth is a race
}

# A Slurm array does this with the lines.
render_all() { while IFS=$'\t' read -r command _; do sh -c "$command" || fail "$command"; done <"$1"; }

test_a_farm_fills_the_cache_and_a_run_only_reads() {
  farm
  expect 0 run farm.yaml --report json=run.json
  rm -r .assay-cache starts
  expect 0 plan farm.yaml --list-renders
  cp out pilot
  [ "$(wc -l <pilot)" = 32 ] || fail "$(wc -l <pilot) renders of the pilot"
  [ "$(wc -l <starts)" = 1 ] || fail 'the list renders more than one picture'
  # The seed and the file stand in the line too.
  while IFS=$'\t' read -r command seed file; do
    [[ $command == *" $seed "* && $file == "$work/.assay-cache/"*"/$seed.exr" && ! -e $file ]] ||
      fail "a line: $command, $seed, $file"
  done <pilot
  (cd / && render_all "$work/pilot")
  expect 0 plan farm.yaml --list-renders
  cp out rest
  [ "$(wc -l <rest)" = 67 ] || fail "$(wc -l <rest) renders of the test"
  # Half of them, and one that was killed while it wrote.
  head -n 33 rest >half
  render_all half
  echo half >"$(dirname "$(tail -n 1 rest | cut -f 3)")/part-of-$(tail -n 1 rest | cut -f 2).exr"
  expect 0 plan farm.yaml --list-renders
  diff <(tail -n +34 rest) out >err || fail 'not the other half'
  render_all out
  expect 0 plan farm.yaml --list-renders
  empty out
  [ "$(wc -l <starts)" = 100 ] || fail "$(wc -l <starts) starts"
  expect 0 run farm.yaml --report json=farm.json
  [ "$(wc -l <starts)" = 100 ] || fail 'the run renders'
  same_tests run.json farm.json || fail 'the farm changes the numbers'
}

# A look may be put off to 64 times the last one. The list has what `in all` says.
test_renders_that_a_heavy_tail_alone_would_need_are_not_listed() {
  cat >text.yaml <<'SUITE'
suite: text
estimators:
  a:
    plugin: command
    output: text
    command: [sh, -c, 'awk -v s=$1 "BEGIN{srand(s); print rand() + rand() + rand()}" >$2', sh, "{seed}", "{out}"]
tests:
  - {claim: mean(a) == 1.5, detect: 5%}
SUITE
  expect 0 plan text.yaml --list-renders
  [ "$(wc -l <out)" = 512 ] || fail "$(wc -l <out) renders of the pilot"
  expect 0 plan text.yaml
  local last
  last=$(awk '/, by t$/ { getline; print $4 }' out)
  [ "$last" -gt 512 ] || fail 'no last look'
  expect 0 plan text.yaml --list-renders
  [ "$(wc -l <out)" = "$last" ] || fail "$(wc -l <out) renders, and the last look has $last"
}

# Pictures of every kind that is read are taken of a program too.
test_a_command_may_write_pfm() {
  cat >render.py <<'PROGRAM'
import random, struct, sys

rng = random.Random(int(sys.argv[1]))
with open(sys.argv[2], "wb") as out:
    out.write(b"Pf\n4 4\n-1.0\n" + b"".join(struct.pack("<f", rng.uniform(0, 1)) for _ in range(16)))
PROGRAM
  cat >pfm.yaml <<'SUITE'
suite: pfm
estimators:
  a: {plugin: command, output: pfm, command: [/usr/bin/python3, -IS, render.py, "{seed}", "{out}"]}
tests:
  - {claim: mean(a) == 0.5, secondaries: 32}
  - {name: off, claim: mean(a) == 0.6, secondaries: 32, expect: fail}
SUITE
  expect 0 run pfm.yaml
}

test_a_command_that_makes_several_pictures_is_listed_one_by_one() {
  farm
  cat >several.sh <<'PROGRAM'
for seed in $(echo "$1" | tr , ' '); do /usr/bin/python3 -IS render.py "$seed" "$2" "$3/$seed.exr"; done
PROGRAM
  sed -i 's|command: .*|command: [sh, several.sh, "{seeds}", "{samples}", "{out}"]|' farm.yaml
  expect 0 plan farm.yaml --list-renders
  render_all out
  expect 0 plan farm.yaml --list-renders
  [ "$(wc -l <out)" = 67 ] || fail "$(wc -l <out) renders"
  [ "$(find .assay-cache -name 'part-*')" = '' ] || fail 'a folder is left'
}

"$3"
