#!/usr/bin/env bash
# Mistakes of new users: the answer names the place and the mend, in 80 columns. TEST is one of the
# functions test_… below.
#   mistakes_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"

# answers CODE MESSAGE ARGUMENT…
answers() {
  local code=$1 message=$2
  shift 2
  expect "$code" "$@"
  empty out
  [ "$(tr -s ' \n' ' ' <err | grep -cF -- "$message")" = 1 ] ||
    fail "assay $*: no \`$message\`"
  [ "$(LC_ALL=C.UTF-8 wc -L <err)" -le 80 ] || fail "assay $*: a line is wider than 80 columns"
}

# A suite whose only test is this one.
suite_of() {
  printf '%s\n' 'suite: s' 'estimators:' '  area: {plugin: luminaire/area, scene: triangle}' \
    'tests:' "  - $1" >s.yaml
}

test_mistakes_in_a_test_say_what_to_write() {
  local test message
  while IFS='|' read -r test message; do
    suite_of "$test"
    answers 2 "s.yaml:5:$message" run s.yaml
  done <<'TABLE'
claim: mean(area) = analytic|23: a lone `=`; did you mean `==`?
claim: mean(aera) == analytic|17: the suite has no estimator `aera`; did you mean `area`?
claim: mean(area.red) == analytic|17: `area` has no part `red`; it has `irradiance`
claim: mean(area) == 48%|28: a value has no per cent: write `0.48`, or a margin, as in `mean(a) within 48% of 0.5`
claim: area == 0.48|12: expected a quantity, as in `mean(area)`, found `area`
claim: mean(area)|22: the claim is not complete: add `== analytic`, `<= 0.5`, …
claim: 0.4 < mean(area) < 0.5|12: a claim begins with a quantity, as in `mean(a) < 2 * mean(b)`; a range is `mean(a) within 0.05 of 0.45`
claim: distribution(area) == gaussian(0, 1)|34: a quantity cannot be compared with `gaussian`; did you mean `normal(0, 1)`?
claim: mean(area) within 5 of analytic|30: the margin 5 is larger than the reference, 0.481: for 5 per cent write `5%`
{claim: quantile(area, 0.5) == 0.4}|28: inside {…} a comma ends the value of `claim`; quote the claim: `claim: "quantile(area, 0.5) == 0.4"`
{claim: mean(area) == analytic, detect: 5}|45: the margin 5 is larger than the reference, 0.481: for 5 per cent write `5%`; for so large a margin, `1040%`
{claim: mean(area) == analytic, detect: 0}|37: `detect` must be above 0: it is the effect that must not pass, as `1%`
{claim: distribution(area.point) == density, detect: 5}|58: a difference of probabilities is below 1, so it cannot be 5; write 5 per cent as `0.05`
{claim: mean(area) == analytic, expect: failed}|45: `expect` cannot be `failed`; did you mean `fail`?
{claim: mean(area) == analytic, tags: slow}|43: `tags` must be a list: `tags: [slow, images]`
{claim: mean(area) == analytic, test: F}|37: `F` cannot test `mean(area) == analytic`; there is `t`
{claim: mean(area) == analytic, tolerance: 1%}|37: unknown key `tolerance` of a test; did you mean `allow`?
{claim: mean(area) == analytic, primaries: 4}|37: `primaries` belongs to an estimator, or to the `budget` of a test
TABLE
}

test_pixels_that_one_side_leaves_out_are_refused() {
  /usr/bin/python3 -I - <<'PROGRAM'
import math, random, struct

def picture(name, number, width=8):
    with open(name, "wb") as out:
        out.write(b"PF\n%d 4\n-1.0\n" % width)
        out.write(b"".join(struct.pack("<f", number()) for _ in range(3 * 4 * width)))

for side in "ab":
    for i in range(16):
        rng = random.Random(f"{side}{i}")
        picture(f"{side}{i:02}.pfm", lambda: rng.uniform(0.5, 1.5))
pixels = iter([0.0] * 3 + [1.0] * 93)  # one is black
picture("mask.pfm", lambda: next(pixels))
picture("large.pfm", lambda: 1.0, 10)
numbers = iter([1.0] * 44 + [math.nan] * 4 + [1.0] * 48)  # pixels 6 and 7 of the second row from below
picture("nan.pfm", lambda: next(numbers))
PROGRAM
  local claim message
  while IFS='|' read -r claim message; do
    printf '%s\n' 'suite: s' 'estimators:' "  a: {plugin: recorded, file: 'a*.pfm', mask: mask.pfm}" \
      "  b: {plugin: recorded, file: 'b*.pfm'}" 'tests:' "  - claim: $claim" >s.yaml
    answers 2 "$message" run s.yaml
  done <<'TABLE'
mean(a) == mean(b)|`a` and `b` do not leave out the same pixels
total_variance(a) <= total_variance(b)|`a` and `b` do not leave out the same pixels
mean(a) == 1|`a` leaves out pixels, but a number is claimed of all pixels
mean(a.average) == 1|`a.average` counts pixels that `mask` or `finite` leaves out as 0
TABLE
  local sides=(--candidate 'a*.pfm' --reference 'b*.pfm')
  answers 2 '--candidate a*.exr: no file matches; did you mean `*.pfm`?' \
    images --candidate 'a*.exr' --reference 'b*.pfm'
  answers 2 'parameter `mask` is `large.pfm`: it has 10 x 4 pixels, and the pictures have 8 x 4' \
    images "${sides[@]}" --mask large.pfm
  answers 2 'goes with `==`, not with `within`' images "${sides[@]}" --law --within 1%
  expect 0 images "${sides[@]}" --mask mask.pfm
  contains out '1 of 32 pixels are left'
  contains out 'what is wrong there stays hidden'
  mv nan.pfm a00.pfm
  expect 1 images "${sides[@]}"
  contains out 'at pixel x 6, y 2 of B is not finite'
  contains out '2 of 32 pixels are not finite in some picture'
  contains out '--ignore nonfinite'
}

test_mistakes_at_the_head_of_a_suite_say_what_to_write() {
  local line message
  while IFS='|' read -r line message; do
    printf '%b\n' "$line" >s.yaml
    answers 2 "s.yaml:$message" run s.yaml
  done <<'TABLE'
estimators: {a: {plugin: luminaire/area}}|1:1: a suite needs the key `suite`, as in `suite: my first suite`
suite: s\nseed: random|2:7: a suite's seed is a number, so that its runs repeat; `assay run --seed random` takes a fresh one
suite: s\nalpha: 5%|2:8: `alpha` must be a number from 1e-9 to 0.5 (5 % is 0.05), but it is `5%`
suite: s\nestimators:\n  - a: {plugin: luminaire/area}|3:3: `estimators` must be a map of at least one name to its plugin, without `- `
suite: s\nestimators:\n\ta: {plugin: luminaire/area}|3:1: indent with spaces, not with a tab
suite: s\nestimators: {a: {plugin: luminare/area}}|2:26: there is no plugin `luminare/area`; did you mean `luminaire/area`?
suite: s\nestimators: {a: {scene: triangle}}|2:17: `a` needs the key `plugin`, as in `a: {plugin: luminaire/area}`
suite: s\nestimators: {a: {plugin: luminaire/area}}|1:1: a suite needs the key `tests`, as in `tests: [claim: mean(area) == analytic]`
TABLE
}

test_all_mistakes_of_a_suite_are_told_at_once() {
  cat >s.yaml <<'SUITE'
suite: s
alpha: 2
estimators:
  area: {plugin: luminaire/area, scene: triangle}
  near: {plugin: luminaire/nearby}
tests:
  - claim: mean(area) = analytic
  - claim: mean(aera) == analytic
  - claim: mean(near) == analytic
  - {claim: mean(area) == analytic, detect: 0}
  - claim: mean(area) == analytic
  - {claim: mean(area) <= 1, tset: t}
statements: [{text: it is so, source: a talk, holds: ["mean(area) = analytic"]}]
SUITE
  cp s.yaml t.yaml
  answers 2 's.yaml:2:8: `alpha` must be' run s.yaml t.yaml
  [ "$(grep -o '^assay: [st].yaml:[0-9]*' err | cut -d: -f3 | tr '\n' ' ')" = \
    '2 5 7 8 10 12 2 5 7 8 ' ] || fail 'not every mistake is told once'
  # What only a prepared estimator shows.
  suite_of 'claim: mean(area.red) == analytic'
  echo '  - {claim: mean(area) >= 0, test: F}' >>s.yaml
  answers 2 'mean(area.red)' run s.yaml
  [ "$(grep -c '^assay: s.yaml' err)" = 2 ] || fail 'not two mistakes'
  { printf '%s\n' 'suite: s' 'estimators: {area: {plugin: luminaire/area}}' 'tests:'
    for i in {1..13}; do echo "  - claim: mean(x$i) == 1"; done; } >u.yaml
  answers 2 'assay: and 3 more' run u.yaml
  [ "$(grep -c '^assay: u.yaml' err)" = 10 ] || fail 'not ten mistakes'
}

test_mistakes_on_the_command_line_say_what_to_write() {
  suite_of '{name: first, claim: mean(area) == analytic, tags: [mean]}'
  answers 2 'cannot read `t.yaml`: there is no such file; did you mean `s.yaml`?' run t.yaml
  answers 2 "quote the pattern, as in 'new/*.pfm'" images --candidate new/1.pfm new/2.pfm
  answers 2 '`--estimator x=recorded,file=s.yaml` reads' check 'mean(x) == 1' --estimator x=s.yaml
  mkdir d && seq 200 >d/n.txt
  answers 2 "\`assay check 'mean(n) == 1' --estimator n=recorded,file=d/n.txt\` reads" \
    check 'mean(d/n.txt) == 1'
  answers 2 '`d/m.txt`: it cannot be read: No such file or directory; did you mean `d/n.txt`?' \
    check 'mean(m) == 1' --estimator m=recorded,file=d/m.txt
  answers 2 'unknown command `s.yaml`; did you mean `assay run s.yaml`?' s.yaml
  answers 2 'unknown command `mean(x) == 1`; did you mean `assay check' 'mean(x) == 1'
  answers 2 'has no option `--detect`; write it into the suite, as the key `detect`' \
    run s.yaml --detect 1%
  answers 2 'has no option `--thread`; did you mean `--threads`?' run s.yaml --thread 2
  answers 2 '--seed must be a whole number from 0 to 18446744073709551615, or `random`, but it is `one`' \
    run s.yaml --seed one
  answers 2 '--coarsen is given more than once' run s.yaml --coarsen 2 --coarsen 3
  answers 2 '--coarsen needs a value: `--coarsen F`' run s.yaml --coarsen
  answers 2 'it is `html`; write `--report html=run.html`' run s.yaml --report html
  answers 2 'it is `out/a.xml`; write `--report junit=out/a.xml`' run s.yaml --report out/a.xml
  answers 2 'put a blank between two reports: write `--report html=a.html json=a.json`' \
    run s.yaml --report html=a.html,json=a.json
  answers 2 'the kind of --report cannot be `pdf`; there is: console, json' \
    run s.yaml --report json=a pdf=b
  answers 2 'no/where/a.html: its folder does not exist; make it by `mkdir -p no/where`' \
    run s.yaml --report html=no/where/a.html
  answers 4 '--tag maen: no test has this tag; did you mean `mean`?' run s.yaml --tag maen
  answers 4 'it must match a whole id, suite/name, where * and ? are wildcards; near it: s/first' \
    run s.yaml --filter first
  answers 4 "no test is left by --filter '-*'" list tests s.yaml --filter '-*'
}

test_mistakes_in_a_check_say_what_to_write() {
  local claim='mean(luminaire/area) == analytic'
  echo 3 >one.txt
  printf '%s\n' 'my value,"other, one"' 1,2 3,4 >columns.csv
  answers 2 'write `column=my value` at the estimator and claim `mean(a)`' \
    check 'mean(a.my) == 3' --estimator a=recorded,file=columns.csv
  answers 2 'write `column="other, one"` at the estimator' \
    check 'mean(a.other) == 3' --estimator a=recorded,file=columns.csv
  answers 2 '`==` is one argument too many; quote the claim and other words with blanks: `assay check' check 'mean(a)' == 3
  answers 2 'claim:1:6: there is no plugin `luminare/area`; did you mean `luminaire/area`?' \
    check 'mean(luminare/area) == analytic'
  answers 2 '--detect 5: the margin 5 is larger than the reference' \
    check "$claim" --detect 5
  answers 2 '--detect 0: `detect` must be above 0' check "$claim" --detect 0
  answers 2 '--test welch: `welch` cannot test `mean(luminaire/area) == analytic`; there is `t`' check "$claim" --test welch
  answers 2 'the claim names `luminaire/area`, not `area`: name `area` there' \
    check "$claim" --estimator area=luminaire/area
  answers 2 'the plugin needs a name, which the claim uses: `--estimator x=recorded,file=one.txt`' \
    check 'mean(x) == 1' --estimator recorded,file=one.txt
  answers 2 "\`absent.txt\`: it cannot be read: No such file or directory; it was sought in \`$PWD\`" \
    check 'mean(x) == 1' --estimator x=recorded,file=absent.txt
  expect 1 check "$claim" --detect 1e-5%
  contains out 'this claim would take about'
  expect 1 check 'mean(x) == 1' --estimator x=recorded,file=one.txt
  contains out '`x` has 1 row, and a check of independence needs 100'
  seq 500 >many.txt
  expect 1 check 'mean(x) == 1' --estimator x=recorded,file=many.txt --budget 10
  contains out 'to decide: give a larger `budget`'
  awk 'BEGIN { for (s = 1; n < 200; ++n) {
    s = s * 16807 % 2147483647; print 0.8136 + 0.4 * s / 2147483647 } }' >near.txt
  expect 3 check 'mean(x) within 1% of 1' --estimator x=recorded,file=near.txt
  contains out 'the estimate misses the claim by less than a standard error'
  expect 0 check --help
  contains out 'the most it may cost: 1e7 primaries with those of the'
  printf '%s\n' 'suite: parts' 'estimators: {a: {plugin: analytic/normal, mean: 0.02, primaries: 1},' \
    ' b: {plugin: analytic/normal, mean: 5000, primaries: 1}}' 'tests: ' \
    '  - {name: large, claim: mean(a) == 0.02, detect: 0.01}' \
    '  - {name: small, claim: mean(b) == 5000, detect: 0.1}' >parts.yaml
  expect 0 run parts.yaml
  contains err '`parts/large`: errors below `detect`, 50 % of what is claimed, may pass; for a part of it write per cent, as in `1%` (1 other doubtful `detect`)'
  expect 0 run parts.yaml --filter '*/small'
  empty err
  contains out '`detect` is 0.002 % of what is claimed; for a part of it write per cent, as in `1%`'
  printf '%s\n' 'suite: idle' 'estimators: {a: {plugin: luminaire/area}, idle: {plugin: luminaire/area}}' \
    'tests: [{claim: mean(a) == analytic, secondaries: 100}]' >idle.yaml
  expect 0 run idle.yaml
  contains err 'no test of `idle` names its estimator `idle`'
  sed -i 's|idle: {|more: {plugin: luminaire/area}, &|' idle.yaml
  expect 0 run idle.yaml
  contains err 'no test of `idle` names its estimators `more`, `idle`'
}

"$3"
