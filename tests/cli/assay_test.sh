#!/usr/bin/env bash
# Drives the program as a user does: exit codes, streams, files, other readers. Runs in a temporary
# folder of its own. TEST is one of the functions test_… below.
#   assay_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"

write_suite() {
  local hemisphere=()  # where a test names it
  case "${*:2}" in *hemisphere*) hemisphere=('  hemisphere: {plugin: luminaire/hemisphere, scene: triangle}') ;; esac
  printf '%s\n' 'suite: small' 'estimators:' \
    '  normal: {plugin: analytic/normal, mean: 2, primaries: 1}' "${hemisphere[@]}" 'tests:' "${@:2}" >"$1"
}

good='  - {name: good, claim: mean(normal) == 2, detect: 20%}'
good2='  - {name: good 2, claim: mean(normal) == 2, detect: 30%}'
wrong='  - {name: wrong, claim: mean(normal) == 3}'
open='  - {name: open, claim: mean(normal) == 2, detect: 1%, secondaries: 100}'
long='  - {name: long, claim: mean(hemisphere) == analytic, secondaries: 100000000}'

test_good_suite_is_0() {
  write_suite good.yaml "$good"
  expect 0 run good.yaml
  contains out '✓ The claim is as it should be in'
}

# Five lines have no room for a long note and for how to repeat it.
test_a_fail_says_how_to_repeat_it() {
  write_suite told.yaml "$good" '  - {name: a name that takes a second line of the command, claim: mean(normal) == 2.06}'
  expect 1 run told.yaml
  contains out 'again: assay run told.yaml'
  contains out "may explain it; declare their \`high\` end"
  lacks out '… (assay explain TEST)'
  seq 200 | awk '{ s = 16807 * (s + !s) % 2147483647; print s / 2147483647 }' >rows.txt
  sed -i 's/mean(normal) == 2.06}/variance(rows) == variance(normal)}/
    s/^estimators:/&\n  rows: {plugin: recorded, file: rows.txt}/' told.yaml
  expect 1 run told.yaml
  contains out 'again: assay run told.yaml'
  contains out '… (assay explain TEST)'
  expect 0 explain 'second line'
  contains out 'Note: a row of `rows` is compared with a single primary of `normal`'
  lacks out 'note:'
}

test_failing_suite_is_1() {
  write_suite fails.yaml "$good" "$wrong"
  expect 1 run fails.yaml
  contains out '✗ 1 of 2 claims broken in'
  contains out '✗ fail: fails/wrong'
}

test_bad_suite_is_2_with_its_place() {
  write_suite bad.yaml '  - {claim: mean(normal) == 2, detct: 1%}'
  expect 2 run bad.yaml
  empty out
  contains err 'bad.yaml:5:32: '
  contains err 'detect'
}

test_every_bad_suite_is_2_with_its_place() {
  local file
  for file in "$source_folder"/tests/suites/bad_*.yaml; do
    expect 2 run "$file"
    empty out
    grep -qE "$(basename "$file"):[0-9]+:[0-9]+:( |$)" err || fail "no place of the mistake in $file"
  done
}

test_mistake_on_the_command_line_is_2() {
  expect 2 run --fliter x good.yaml
  empty out
  contains err '--filter'
  expect 2 run
  expect 2 run no-such-suite.yaml
  contains err 'no-such-suite.yaml'
}

test_undecided_is_3_or_as_asked() {
  write_suite open.yaml "$good" "$open"
  expect 3 run open.yaml
  contains out '? 1 of 2 claims undecided in'
  contains out 'Exit code 3: nothing failed, but not all is decided.'
  expect 1 run open.yaml --inconclusive fail
  contains out 'Exit code 1: undecided claims count as failed.'
  expect 0 run open.yaml --inconclusive pass --report json=open.json
  contains out 'Exit code 0: undecided claims count as passed.'
  expect 0 report open.json
  ! tr '\n' ' ' <out | grep -q 'Exit code' || fail 'an exit code of another command'
  # More of a budget in seconds decides, not a size that sets the budget aside.
  expect 3 check 'mean(luminaire/area) == analytic' --detect 1e-4 --budget 0.3s
  contains out "to decide: assay check 'mean(luminaire/area) == analytic' --detect 1e-4"
  [ -z "$(grep -e '--secondaries' out)" ] || fail 'the advice sets the budget aside'
}

test_advice_stands_below_a_reason_that_is_cut() {
  printf '%s\n' 'suite: h' 'estimators: {h: {plugin: analytic/heavy_tail, index: 2, primaries: 1}}' \
    'tests: [{claim: variance(h) <= 3, secondaries: 20000}]' >heavy.yaml
  expect 3 run heavy.yaml
  contains out '…'
  contains out 'to decide: clamp the estimator or take another, declare its range, or claim a quantile'
  lacks out 'secondaries: 2000000'
  contains out "more: assay explain 'heavy/variance(h) <= 3'"
  expect 3 run heavy.yaml -vv
  ! grep -q 'p = 1' out || fail 'a p-value of no look'
}

test_a_planted_bug_that_passes_twice_is_none() {
  write_suite missed.yaml '  - {claim: mean(normal) == 2, detect: 20%, expect: fail}'
  expect 1 run missed.yaml
  contains out 'write `detect: 10%`; if it passes again, any bug is smaller:'
}

test_filter_that_matches_nothing_is_4() {
  write_suite good.yaml "$good"
  expect 4 run good.yaml --filter 'good/nothing' --report html=run.html
  empty out
  contains err '--filter good/nothing matches no test'
  contains err 'good/good'
  [ ! -e run.html ] || fail 'a report of nothing was written'
}

test_plan_prints_and_draws_no_test() {
  write_suite good.yaml "$good" "$long"
  expect 0 plan good.yaml --quiet
  contains out '  long'
  contains out 'share observations'
  empty err
  printf '%s\n' 'suite: wide' 'estimators:' '  heavy: {plugin: analytic/heavy_tail, index: 3, primaries: 16}' \
    '  normal: {plugin: analytic/normal, primaries: 50000}' 'tests:' \
    '  - {claim: variance(heavy) <= 9, detect: 250%}' '  - {claim: mean(heavy) == mean(normal), secondaries: 123456}' \
    '  - {claim: distribution(heavy) == distribution(normal), test: chi-square-two-sample}' >wide.yaml
  expect 0 plan good.yaml wide.yaml --quiet
  [ "$(LC_ALL=C.UTF-8 wc -L <out)" -le 80 ] || fail 'a line is wider than 80 columns'
  expect 0 plan wide.yaml --quiet
  tr '\n' ' ' <out | grep -q 'Heavy tails may raise this to 6.18 G' || fail 'no word of heavy tails'
  write_suite fixed.yaml '  - {claim: mean(normal) == 2, secondaries: 1000}'
  expect 0 plan fixed.yaml --quiet
  ! tr '\n' ' ' <out | grep -q 'Heavy tails' || fail 'the same number twice'
  expect 4 plan good.yaml --filter 'good/nothing'
  expect 2 plan no-such-suite.yaml
}

# Three tenths of a standard deviation and 100 observations make three standard errors a night. That
# is too few for a test at alpha 1e-9, and enough for ten nights.
test_ledger_alarm_is_1() {
  local night code=0
  write_suite nights.yaml '  - {name: off, claim: mean(normal) == 2.3, secondaries: 100}'
  for night in 1 2 3 4 5 6 7 8 9 10; do
    "$assay" run nights.yaml --alpha 1e-9 --seed "$night" --ledger n.ledger --quiet >out 2>err
    code=$?
  done
  [ "$code" -eq 1 ] || fail "ended with $code, not 1"
  contains out '✗ ledger alarm: nights/off'
  contains out '✗ 1 ledger alarm over all nights. In this run: the claim is as it should be in'
  contains out 'The relative difference from the reference is -1'
  expect 0 explain
  contains out 'The ledger n.ledger raises an alarm for nights/off. The relative difference from the reference is -1'
  lacks out 'Nothing.'
  contains out "echo 'begin \"nights/off\"' >> 'n.ledger'"
  echo 'begin "nights/off"' >>n.ledger
  expect 0 run nights.yaml --alpha 1e-9 --seed 11 --ledger n.ledger --quiet
}

test_ledger_keeps_nights_and_refuses_changed_lines() {
  write_suite good.yaml "$good"
  expect 0 run good.yaml --seed 1 --ledger n.ledger --quiet
  expect 0 run good.yaml --seed 2 --ledger n.ledger --quiet
  contains out 'Ledger n.ledger: 0 alarms in 1 series (false alarms: at most 0.003 a suite)'
  [ "$(tail -n 1 n.ledger)" = 'end 2' ] || fail 'not two nights'
  cp n.ledger before
  expect 0 run good.yaml --seed 2 --ledger n.ledger --quiet
  contains out 'the ledger already has seed 2'
  cmp n.ledger before || fail 'a seed seen before changed the ledger'
  sed -i 's/seed 1 /seed 3 /' n.ledger
  expect 2 run good.yaml --seed 4 --ledger n.ledger --quiet
  empty out
  contains err 'n.ledger:10:1: '
  contains err 'version control'
  head -n -1 before >n.ledger
  expect 2 run good.yaml --seed 4 --ledger n.ledger --quiet
  contains err 'cut short'
}

test_suite_given_twice_is_2() {
  write_suite good.yaml "$good"
  expect 2 run good.yaml good.yaml
  empty out
  contains err '`good.yaml` and `good.yaml` are one suite; give it once'
  expect 2 run good.yaml ./good.yaml
  contains err '`good.yaml` and `./good.yaml` are one suite; give it once'
  mkdir other
  cp good.yaml other
  expect 2 run good.yaml other/good.yaml
  contains err 'are two suites whose tests have the ids `good/…`'
}

test_wrong_value_of_any_option_is_2() {
  local option
  write_suite good.yaml "$good"
  for option in --threads --seed --alpha --inconclusive --color --report --detect --allow --test \
    --primaries --secondaries; do
    expect 2 check 'mean(analytic/dart_throwing) == analytic' $option 'no value of any option'
    empty out
    contains err "$option"
  done
  for option in --threads --seed --alpha --inconclusive --color --report --coarsen --shard --set; do
    expect 2 run good.yaml $option 'no value of any option'
    empty out
    contains err "$option"
  done
}

test_interrupted_before_any_verdict_is_130_and_leaves_no_report() {
  write_suite long.yaml "$long"
  local code=0
  timeout --foreground --preserve-status --signal=INT 1 \
    "$assay" run long.yaml --report json=run.json --report html=run.html >out 2>err || code=$?
  [ "$code" -eq 130 ] || fail "ended with $code, not 130"
  empty out
  [ "$(find . -name '*run.*' | wc -l)" -eq 0 ] || fail "a report is left: $(ls -A)"
}

test_report_that_cannot_be_written_is_2() {
  write_suite good.yaml "$good"
  expect 2 run good.yaml --report json=missing/run.json
  contains err 'missing/run.json'
  : >file
  expect 2 run good.yaml --report json=file/run.json
  [ "$(find . -name '*run.json*' | wc -l)" -eq 0 ] || fail "something was left: $(ls -A)"
}

test_report_over_what_is_read_is_2() {
  write_suite good.yaml "$good"
  cp good.yaml before
  expect 2 run good.yaml --report json=./good.yaml
  contains err 'name another file'
  cmp good.yaml before || fail 'the suite was written over'
  expect 2 run good.yaml --seed 1 --ledger n.ledger --report html=./n.ledger
  expect 0 run good.yaml --report json=run.json
  cp run.json before
  expect 2 report run.json --report html=run.json
  cmp run.json before || fail 'the saved run was written over'
  "$assay" sample analytic/normal --secondaries 200 >rows.txt 2>err
  cp rows.txt before
  expect 2 check 'mean(old) == 0' --estimator 'old=recorded,file=rows.txt' --report html=rows.txt
  contains err 'rows.txt: is a file of this command'
  cmp rows.txt before || fail 'the rows were written over'
}

test_report_replaces_the_old_file_whole() {
  write_suite good.yaml "$good"
  head -c 1000000 /dev/zero >run.json
  expect 0 run good.yaml --report json=run.json
  python3 -m json.tool run.json >/dev/null || fail 'not JSON'
  [ "$(find . -name .cache -prune -o -name '*run.json*' -print | wc -l)" -eq 1 ] || fail "a temporary file is left: $(ls -A)"
}

test_json_on_standard_output_is_all_there_is() {
  write_suite good.yaml "$good"
  expect 0 run good.yaml --report json=-
  python3 -m json.tool out >/dev/null || fail 'standard output is not JSON'
  contains err '✓ The claim is as it should be in'
}

test_reports_are_what_other_programs_read() {
  write_suite all.yaml "$good" "$wrong" "$open" '  - {name: "<&>", claim: mean(normal) <= 3}'
  expect 1 run all.yaml --report json=run.json --report junit=run.xml --report html=run.html
  xmllint --noout --nonet run.xml || fail 'JUnit is not well formed'
  contains run.html 'Content-Security-Policy'
  local tests=$source_folder/tests/reports
  /usr/bin/python3 "$tests/check_junit.py" run.xml run.json || fail 'junitparser'
  /usr/bin/python3 "$tests/check_schema.py" "$source_folder/reports/record/record.schema.json" run.json ||
    fail 'the record does not follow its schema'
}

test_a_record_of_laws_of_pictures_follows_its_schema() {
  /usr/bin/python3 -c '
import random, struct
for side, mean in ("a", 1), ("b", 2):
    for i in range(32):
        numbers = [random.Random(f"{side}{i}{k}").gauss(mean, 1) for k in range(192)]
        open(f"{side}{i}.pfm", "wb").write(b"PF\n8 8\n-1\n" + struct.pack("<192f", *numbers))'
  expect 1 images --law --candidate 'a*.pfm' --reference 'b*.pfm' --report json=run.json
  /usr/bin/python3 "$source_folder/tests/reports/check_schema.py" \
    "$source_folder/reports/record/record.schema.json" run.json || fail 'not its schema'
}

test_a_place_of_one_pixel_is_not_weighted() {
  /usr/bin/python3 -c '
import random, struct
for side in "ab":
    for i in range(20):
        light = [random.Random(f"{side}{i}{k}").gauss(1, .1) for k in range(144)]
        if side == "a": light[31] += .6; light[32] += .3
        open(f"{side}{i}.pfm", "wb").write(b"PF\n8 6\n-1\n" + struct.pack("<144f", *light))'
  expect 1 images --candidate 'a*.pfm' --reference 'b*.pfm'
  contains out 'pixel x 2, y 4 of G is 66.4 % too bright (48.4 % to 84.4 %); there B differs by'
}

# The reference has noise of its own, which no place shows.
test_a_pass_says_if_all_pixels_together_differ() {
  /usr/bin/python3 -c '
import random, struct
def picture(name, noise):
    numbers = [random.Random(f"{name}{k}").gauss(1, noise) for k in range(3072)]
    open(f"{name}.pfm", "wb").write(b"PF\n32 32\n-1\n" + struct.pack("<3072f", *numbers))
for i in range(32):
    picture(f"a{i}", 0.3)
    light = [random.Random(k).gauss(1, 0.05) + random.Random(f"{i} {k}").gauss(0, 0.3)
             for k in range(3072)]
    open(f"c{i}.pfm", "wb").write(b"PF\n32 32\n-1\n" + struct.pack("<3072f", *light))
picture("exact", 0)
picture("noisy", 0.025)'
  expect 0 images --candidate 'a*.pfm' --reference noisy.pfm
  contains out 'no place differs beyond noise, but all pixels together do'
  contains out 'RMS 2.'
  contains out ' 32 pictures'
  expect 1 images --candidate 'a*.pfm' --reference noisy.pfm --within 1%
  contains out 'relative root mean square difference of the images is 2'
  expect 0 images --candidate 'a*.pfm' --reference exact.pfm
  contains out 'no evidence against the claim'
  # Two sides have no such noise: what fails with a tolerance fails without.
  for allow in 0 0.5%; do
    expect 1 images --candidate 'a*.pfm' --reference 'c*.pfm' --allow $allow
    contains out 'difference of the images is '
  done
}

# All pixels are an eighth of their noise too bright. A quarter of them have a hundred times the noise, and hardly a weight.
test_an_effect_that_weights_hide_is_told_unweighted() {
  /usr/bin/python3 -c '
import random, struct
for side, shift in (("a", 0.125), ("b", 0)):
    for i in range(32):
        noise = [0.01 if k % 32 < 24 else 1 for k in range(1024)]
        values = [random.Random(f"{side} {i} {k}").gauss(3 + shift * s, s)
                  for k, s in enumerate(noise)]
        open(f"{side}{i}.pfm", "wb").write(b"Pf\n32 32\n-1\n" + struct.pack("<1024f", *values))'
  expect 1 images --candidate 'a*.pfm' --reference 'b*.pfm'
  contains out 'the whole image is 0.0'
  contains out '(plain means)'
  contains out 'differs by +1'
}

# One side has no noise.
test_black_pictures_fail_beside_any_other() {
  /usr/bin/python3 -c '
import random, struct
for side in "ab":
    for i in range(16):
        values = [0.0 if side == "a" else random.gauss(1, .1) for _ in range(64)]
        open(f"{side}{i}.pfm", "wb").write(b"Pf\n8 8\n-1.0\n" + struct.pack("<64f", *values))'
  local other
  for other in 'b*.pfm' b0.pfm; do
    expect 1 images --candidate 'a*.pfm' --reference "$other"
    contains out 'too dark'
    expect 1 images --candidate 'a*.pfm' --reference "$other" --within 5%
    contains out 'difference of the images is 100 %'
  done
}

# Against one picture: neighbours show how large values may be that a pixel never showed. A dark
# lamp has no such neighbours, and is in sums of the image.
test_a_pixel_that_never_varies_is_held_against_other_pixels() {
  /usr/bin/python3 -c '
import random, struct
def write(name, values):
    open(name, "wb").write(b"Pf\n40 40\n-1.0\n" + struct.pack("<1600f", *values))
lamp = {x + 40 * y for x in range(20, 40) for y in range(20, 40)}
random.seed(1)
write("exact.pfm", [20.0 if i in lamp else 1.0 for i in range(1600)])
write("seldom.pfm", [20.0 if i in lamp else 0.01 if i == 205 else 1.0 for i in range(1600)])
for i in range(24):
    drawn = [20.0 if i in lamp else random.lognormvariate(-.08, .4) for i in range(1600)]
    write(f"good{i}.pfm", drawn)
    dead = [0.0 if i == 205 else x for i, x in enumerate(drawn)]
    write(f"dead{i}.pfm", dead)
    write(f"off{i}.pfm", [0.0 if i in lamp else x for i, x in enumerate(drawn)])
    write(f"hole{i}.pfm", [0.0 if i == 1230 else x for i, x in enumerate(drawn)])'
  expect 0 images --candidate 'good*.pfm' --reference exact.pfm
  expect 0 images --candidate 'dead*.pfm' --reference seldom.pfm
  contains out '1 value never varies and differs from the reference, at pixel x 5, y 34 of Y: rare'
  expect 1 images --candidate 'dead*.pfm' --reference exact.pfm
  contains out 'pixel x 5, y 34 is 100 % too dark'
  expect 1 images --candidate 'hole*.pfm' --reference exact.pfm
  contains out 'pixel x 30, y 9 is 100 % too dark'
  cp good1.pfm good99.pfm
  expect 1 images --candidate 'good*.pfm' --reference exact.pfm
  contains out '    `candidate`: `good99.pfm` is the same picture as `good1.pfm`'
  expect 1 images --candidate 'off*.pfm' --reference exact.pfm
  contains out '    x 20-39, y 0-19 is 100 % too dark'
}

# A hundred times as many rows would show a hundred times as much of the tail.
test_rows_that_few_values_make_up_are_sent_to_quantiles() {
  /usr/bin/python3 -c '
import random
for side in "ab":
    draw = random.Random(side).lognormvariate
    open(f"{side}.txt", "w").writelines(f"{draw(0, 2)}\n" for _ in range(1000))'
  expect 3 check 'variance(a) < variance(b)' --estimator a=recorded,file=a.txt \
    --estimator b=recorded,file=b.txt
  contains out 'may only show more of the tail to decide: claim a quantile'
}

test_sampled_file_is_checked_as_recorded() {
  expect 0 sample analytic/normal --secondaries 2000
  cp out data.txt
  expect 0 check 'mean(recorded) == 0' --estimator 'recorded=recorded,file=data.txt'
  expect 1 check 'mean(recorded) == 0.5' --estimator 'recorded=recorded,file=data.txt'
  expect 2 check 'mean(recorded) == 0' --secondaries 2001 \
    --estimator 'recorded=recorded,file=data.txt'
  contains err '2000'
}

test_numbers_come_through_pipes() {
  "$assay" sample analytic/normal --secondaries 2000 >data.txt
  local file code
  for file in - /dev/stdin; do
    code=0
    cat data.txt | "$assay" check 'mean(mine) == 0' --estimator "mine=recorded,file=$file" \
      --report json=run.json >out 2>err || code=$?
    [ "$code" -eq 0 ] || fail "numbers from $file: $code"
    contains out 'again: standard input cannot be read again: write it to a file'
    expect 2 replay run.json 'check/mean(mine) == 0'
    contains err 'standard input cannot be read'
  done
  expect 0 check 'mean(mine) == 0' --estimator mine=recorded,file=<(cat data.txt)
  gzip -k data.txt
  expect 0 check 'mean(mine) == 0' --estimator mine=recorded,file=data.txt.gz
  # Two columns of one stream are no independent samples, and neither are a stream and its file.
  awk '{print $1, $1 + 1}' data.txt | grep -v '^#' >two.txt
  code=0
  "$assay" check 'mean(a) == mean(b)' --estimator a=recorded,file=-,column=value1 \
    --estimator b=recorded,file=two.txt,column=value2 <two.txt >out 2>err || code=$?
  [ "$code" -eq 2 ] || fail "a file and itself as standard input: $code"
  contains err 'both sides are read from'
  code=0
  printf '1\n2\nthree\n' | "$assay" check 'mean(mine) == 0' --estimator mine=recorded,file=- \
    >out 2>err || code=$?
  [ "$code" -eq 2 ] || fail "a word among numbers: $code"
  contains err 'standard input:3:1: `three` is not a number'
  contains err '  three'
}

test_no_byte_of_a_data_file_reaches_the_terminal() {
  printf '1 2\n3 \033[31m\2334\n' >escape.txt
  head -c 3000 "$assay" >binary.txt
  local file
  for file in escape.txt binary.txt; do
    expect 2 check 'mean(mine) == 0' --estimator mine=recorded,file=$file
    ! LC_ALL=C grep -q '[^[:print:][:space:]]' <(tr -d '\200-\377' <err) || fail "$file is shown"
    iconv -f UTF-8 -t UTF-16 err >/dev/null || fail "bytes of $file are shown"
  done
  contains err 'is a binary file, not text'
}

test_many_columns_are_few_lines() {
  awk 'BEGIN { for (i = 0; i < 300; ++i) { for (j = 0; j < 500; ++j) printf "%d ", (i * j) % 7
    print "" } }' >wide.txt
  local options=(--estimator mine=recorded,file=wide.txt)
  "$assay" check 'mean(mine) == 3' "${options[@]}" -vv >out 2>err
  [ "$(wc -l <out)" -lt 150 ] || fail "500 columns are $(wc -l <out) lines"
  contains out '476 more channels'
  expect 2 check 'mean(mine.none) == 3' "${options[@]}"
  [ "$(wc -c <err)" -lt 1000 ] || fail 'an unknown column is answered by all of them'
}

test_check_names_a_plugin_directly() {
  expect 0 check 'mean(luminaire/area) == 0.481046907316' --detect 5%
  expect 1 check 'mean(luminaire/area) == 0.6' --detect 5%
  expect 2 check 'mean(luminaire/aera) == 0.48'
  contains err 'luminaire/area'
}

test_replay_gives_the_same_numbers() {
  write_suite good.yaml "$good" "$wrong"
  expect 1 run good.yaml --seed 12 --report json=run.json
  expect 0 replay run.json good/wrong
  contains out 'the same numbers as recorded'
  expect 0 replay run.json wrong 3
  contains out 'observation 3: '
  expect 0 replay good/wrong
  contains out 'the same numbers as recorded'
  expect 0 replay wrong 3
  contains out 'observation 3: '
  expect 2 replay run.json good/wrnog
  contains err 'good/wrong'
}

test_replay_finds_the_suites_files_from_elsewhere() {
  mkdir -p there/suites elsewhere
  "$assay" sample analytic/normal --secondaries 200 >there/suites/data.txt
  printf '%s\n' 'suite: data' 'estimators:' '  rows: {plugin: recorded, file: data.txt}' 'tests:' \
    '  - {name: rows, claim: mean(rows) == 0}' >there/suites/data.yaml
  (cd there && "$assay" run suites/data.yaml --quiet --report json=run.json >../out 2>../err)
  cd elsewhere
  local code=0
  "$assay" replay ../there/run.json data/rows >../out 2>../err || code=$?
  [ "$code" -eq 0 ] || fail "replay from elsewhere ended with $code"
  rm ../there/suites/data.txt
  code=0
  "$assay" replay ../there/run.json data/rows >../out 2>../err || code=$?
  [ "$code" -eq 2 ] || fail "replay without the file ended with $code"
  contains ../err "$work/there/suites/data.txt"
}

test_replay_line_of_the_report_gives_the_same_numbers() {
  write_suite good.yaml "$good" "$wrong"
  expect 1 run good.yaml --report json=run.json
  local line
  line=$(python3 -c 'import json
print(json.load(open("run.json"))["suites"][0]["tests"][1]["replay"])')
  eval "\"$assay\" ${line#assay } --report json=again.json" >out 2>err
  python3 - <<'PY' || fail "\`$line\` gives other numbers"
import json
one, again = (json.load(open(f))["suites"][0]["tests"] for f in ("run.json", "again.json"))
assert len(again) == 1 and again[0]["id"] == one[1]["id"]
assert again[0]["log10_p"] == one[1]["log10_p"] and again[0]["statistic"] == one[1]["statistic"]
PY
}

test_saved_run_gives_other_reports() {
  write_suite good.yaml "$good"
  expect 0 run good.yaml --report json=run.json --report markdown=run.md
  expect 0 report run.json --report markdown=-
  cmp -s out run.md || fail 'the Markdown of the saved run differs'
}

test_settings_are_advised_in_the_options_of_a_command_line() {
  expect 1 check 'cost(a) == 1' --estimator a=analytic/normal
  contains out 'write `--cost samples`'
}

test_threads_do_not_change_a_bit() {
  write_suite all.yaml "$good" "$wrong" '  - {claim: mean(hemisphere) == analytic, detect: 5%}'
  expect 1 run all.yaml --threads 1 --report json=one.json
  expect 1 run all.yaml --threads 2 --report json=two.json
  local times='s/"(started|seconds|threads)": *("[^"]*"|[-+0-9.e]+)/"\1": 0/g'
  cmp -s <(sed -E "$times" one.json) <(sed -E "$times" two.json) || fail 'the records differ'
}

test_broken_claims_are_told_before_a_run_ends_early() {
  write_suite hasty.yaml "$long" "$wrong"
  expect 1 run hasty.yaml --fail-fast --durations 1
  contains out '✗ fail: hasty/wrong'
  contains out 'the run ended early: `hasty/wrong` is broken'
  contains out 'Slowest, by CPU time of their draws:'
  expect 2 run hasty.yaml --fail-fast --ledger n.ledger
  contains err 'leave --ledger and --shard out'
}

test_explain_tells_of_the_last_run() {
  export XDG_CACHE_HOME=$work/cache
  expect 2 explain open
  contains err 'there is no last run'
  write_suite mixed.yaml "$good" "$wrong" "$open"
  expect 1 run mixed.yaml --report json=run.json
  expect 0 explain open
  contains out 'The observations do not suffice'
  contains out 'The last run from this folder began'
  contains out 'secondaries: '
  expect 2 explain
  contains err 'assay: the last run: 2 tests match; give the id of one'
  expect 0 explain run.json mixed/wrong
  contains out 'The claim is wrong.'
  expect 2 explain mixed/
  contains err '3 tests match `mixed/`'
  expect 2 explain mixed/wrnog
  contains err 'mixed/wrong'
  contains err 'another run is kept by `--report json=FILE`: give FILE before the test'
  expect 2 explain run.json mixed/wrnog
  lacks err 'another run'
  expect 2 replay mixed/wrnog
  contains err 'assay: the last run: no test `mixed/wrnog`'
  write_suite broken.yaml "$good" "$wrong"
  expect 1 run broken.yaml
  expect 0 explain
  contains out 'broken/wrong'
  write_suite single.yaml "$good"
  expect 0 run single.yaml --report json=single.json
  expect 0 explain
  contains out 'Nothing speaks against the claim.'
  expect 0 explain single.json
  contains out 'Nothing speaks against the claim.'
  mkdir elsewhere
  cd elsewhere || exit 1
  expect 2 explain open
  contains err 'there is no last run from this folder'
  cd ..
  # A folder that cannot be made changes nothing.
  : >file
  XDG_CACHE_HOME=$work/file expect 1 run mixed.yaml
  empty err
}

test_colours_are_as_asked() {
  local escape=$'\033'
  write_suite good.yaml "$good"
  expect 0 run good.yaml
  lacks out "$escape"
  FORCE_COLOR=1 expect 0 run good.yaml
  contains out "$escape"
  NO_COLOR=1 FORCE_COLOR=1 expect 0 run good.yaml
  lacks out "$escape"
  NO_COLOR=1 expect 0 run good.yaml --color always
  contains out "$escape"
  FORCE_COLOR=1 expect 0 run good.yaml --color never
  lacks out "$escape"
}

test_full_disk_is_no_success() {
  [ -e /dev/full ] || return 0
  write_suite good.yaml "$good"
  local code=0
  "$assay" run good.yaml --report json=- >/dev/full 2>err || code=$?
  [ "$code" -eq 2 ] || fail "ended with $code, not 2"
  contains err 'No space left on device'
  code=0
  "$assay" help claims >/dev/full 2>err || code=$?
  [ "$code" -eq 2 ] || fail "help ended with $code, not 2"
  contains err 'standard output: cannot write'
  expect 2 run good.yaml --report html=/dev/full
  contains err 'cannot write /dev/full'
  lacks out '/dev/full'
}

# A build by tools that say what they are asked and fail as asked.
build_with() {
  mkdir -p tools
  printf '%s\n' '#!/bin/sh' 'case "$*" in *" -n") echo "$PLANNED"; exit;; esac' \
    'echo "cmake $*"' 'exit "$ENDS_WITH"' >tools/cmake
  chmod +x tools/cmake
  PLANNED=$1 ENDS_WITH=$2 PATH=$PWD/tools:$PATH bash -c "set -euo pipefail
    source '$source_folder/suites/install.sh'
    build_project built assay" >out 2>err
}

test_build_speaks_when_it_works_or_fails() {
  build_with '' 0 || fail 'the build failed'
  contains err 'building Assay (a few minutes the first time)…'
  contains built/build.log 'cmake --build built --target assay'
  : >built/build.ninja
  build_with 'ninja: no work to do.' 0 || fail 'the build failed'
  empty out
  empty err
  ! build_with '[1/2] compile' 1 || fail 'the build did not fail'
  contains err 'building Assay…'
  contains err 'the end of built/build.log:'
  contains err 'cmake -G Ninja'
  contains err 'the build failed; all of it is in built/build.log'
}

test_calibration_tells_what_errs_and_writes_its_reports() {
  expect 0 calibrate --help
  contains out 'assay calibrate ['
  expect 0 calibrate t --law normal --alpha 0.05 --runs 20 --quiet --report html=c.html \
    --report json=c.json --report markdown=c.md
  contains out 'mean == number'
  contains out 'err too often'
  contains c.html '<title>Assay: calibration'
  /usr/bin/python3 -c 'import json; assert json.load(open("c.json"))["report"] == "calibration"' ||
    fail 'no JSON'
  expect 2 calibrate welsh
  contains err 'did you mean `welch`'
  expect 2 calibrate nothing
  contains err 'influence-t'
  expect 2 calibrate --law cauchy
  contains err 'student_t(5)'
  expect 2 calibrate --law 'pareto(1, 1.5)'
  contains err '`pareto(1, 1.5)` has no variance, so no method promises anything'
  expect 0 calibrate t --law 'pareto(1, 4.5)' --alpha 0.05 --runs 2 --quiet
  [ -z "$(awk 'length > 80' out)" ] || fail 'a line of more than 80 columns'
  expect 2 calibrate --report junit=c.xml
  contains err 'no junit report'
  expect 2 calibrate t --alpha 0.01 --alpha 1e-2
  contains err '--alpha 0.01 is given twice'
  expect 2 calibrate t welch t
  contains err 'METHOD t is given twice'
  expect 2 calibrate t --law normal --law 'normal(0,1)'
  contains err '--law normal(0,1) is given twice'
  expect 2 calibrate --runs 0
  contains err '--runs'
}

# shown FILE EXPRESSION: of a record, by Python.
shown() { /usr/bin/python3 -c "import json, sys; r = json.load(open('$1')); print($2)"; }

test_shards_of_four_processes_merge_to_one_run() {
  local i processes=()
  mkdir shards merged
  write_suite many.yaml "$good" "$wrong" '  - {claim: mean(hemisphere) == analytic}' \
    '  - {claim: variance(normal) == 1}' '  - {claim: distribution(hemisphere.direction) == density}'
  expect 1 run many.yaml --quiet --report json=run.json --report html=run.html
  for i in 4 2 3 1; do
    "$assay" run many.yaml --quiet --shard "$i/4" --threads "$i" --report "json=shards/$i.json" \
      >/dev/null &
    processes+=($!)
  done
  wait "${processes[@]}"
  expect 1 merge shards/2.json shards/4.json shards/1.json shards/3.json \
    --report json=merged/run.json --report html=merged/run.html
  contains out '✗ 1 of 5 claims broken'
  diff <(timeless run.json) <(timeless merged/run.json) || fail 'the merged record is another'
  expect 1 merge shards/2.json shards/4.json shards/1.json --report json=merged/part.json --report console=-
  contains err 'of 4 shards these are missing, so their tests are skipped: 3; run them with --shard 3/4'
  contains merged/part.json '"message": "shard 3 of 4 is missing"'
  [ "$(shown merged/part.json 'sorted(t["name"] for t in r["suites"][0]["tests"])')" = \
    "$(shown run.json 'sorted(t["name"] for t in r["suites"][0]["tests"])')" ] || fail 'a test is lost'
  expect 2 merge shards/2.json run.json
  contains err 'run.json: is a whole run, not a shard'
  expect 2 merge
  contains err 'needs the records of all shards'
  expect 2 merge many.yaml
  contains err 'looks like a suite, not a saved run'
}

# Tests of one stream stay together, so the two are of two.
test_environment_asks_for_a_shard() {
  write_suite many.yaml "$good" '  - {claim: mean(hemisphere) == analytic}'
  export GTEST_TOTAL_SHARDS=3 GTEST_SHARD_INDEX=1 GTEST_SHARD_STATUS_FILE=$work/status
  expect 0 run many.yaml --report json=run.json
  [ -e status ] || fail 'no status file'
  [ "$(shown run.json '[r["shard"]["index"], r["shard"]["count"]]')" = '[2, 3]' ] ||
    fail 'not shard 2 of 3'
  [ "$(shown run.json '[t["name"] for t in r["suites"][0]["tests"]]')" = "['good']" ] ||
    fail 'not its test'
  GTEST_SHARD_INDEX=2 expect 0 run many.yaml
  contains out 'Shard 3 of 3: No claim was tested'
  expect 0 run many.yaml --shard 1/2 --report json=run.json
  [ "$(shown run.json '[r["shard"]["index"], r["shard"]["count"]]')" = '[1, 2]' ] ||
    fail 'the flag did not win'
  expect 4 run many.yaml --shard 3/3
  GTEST_SHARD_INDEX=3 expect 2 run many.yaml
  contains err 'GTEST_SHARD_INDEX is 3'
}

test_github_is_told_what_is_not_ok() {
  write_suite mixed.yaml "$good" "$wrong"
  printf 'earlier\n' >summary.md
  export GITHUB_ACTIONS=true GITHUB_STEP_SUMMARY=$work/summary.md
  expect 1 run mixed.yaml --quiet
  contains err '::error file=mixed.yaml,line=6,title=fail%3A mixed/wrong::'
  [ "$(grep -c '^::' err)" -eq 1 ] || fail 'more than one annotation'
  contains out '✗ 1 of 2 claims broken in'
  [ "$(head -n 1 summary.md)" = earlier ] || fail 'the summary was not appended to'
  contains summary.md 'claims broken'
  cp summary.md before.md
  expect 1 run mixed.yaml --quiet --github never
  lacks err '::error'
  cmp -s summary.md before.md || fail 'a summary though it was turned off'
}

test_metrics_end_as_openmetrics_do() {
  write_suite good.yaml "$good"
  expect 0 run good.yaml --quiet --report metrics=metrics.txt
  contains metrics.txt 'assay_ok{test="good/good",verdict="pass"} 1'
  contains metrics.txt 'assay_mean{suite="small",estimator="normal",channel="value"} '
  [ "$(tail -n 1 metrics.txt)" = '# EOF' ] || fail 'no end'
}

test_check_points_at_the_option_that_is_wrong() {
  expect 2 check 'mean(analytic/dart_throwing) == analytic' --test F
  contains err 'assay: --test F: `F` cannot test `mean(analytic/dart_throwing) == analytic`; there is `t`'
  lacks err '^'
  expect 2 check 'mean(analytic/dart_throwing) == analytic' --detect 0
  contains err 'assay: --detect 0: `detect` must be above 0'
  : >empty.yaml
  expect 2 run empty.yaml
  [ "$(cat err)" = 'assay: empty.yaml:1:1: the file is empty' ] || fail 'more than the place'
}

test_help_is_a_command() {
  expect 0 help claims
  contains out '`detect` effect that must not pass'
  lacks out 'How to add'
  [ "$(LC_ALL=C.UTF-8 wc -L <out)" -le 80 ] || fail 'a line of `help claims` is wider than 80 columns'
  expect 0 help all
  contains out 'Exit codes:'
  local command
  for command in $(sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p' out); do
    [ "$command" = help ] || expect 0 help "$command"
    ! grep -qE '^.{81,}$' out || fail "a line of \`help $command\` is wider than 80 columns"
  done
  expect 0 help run
  contains out 'assay run ['
  expect 2 help rnu
  contains err 'did you mean `run`?'
}

test_lists_are_one_id_a_line() {
  write_suite good.yaml "$good" "$wrong"
  expect 0 list tests good.yaml
  [ "$(cat out)" = $'good/good\ngood/wrong' ] || fail 'not the two tests'
  expect 0 list plugins
  contains out 'luminaire/area'
  expect 0 list
  [ "$(head -n 2 out)" = $'assay list plugins\nassay list tests SUITE...' ] || fail 'no lists'
  contains out 'assay list methods'
  expect 0 describe luminaire
  contains out 'luminaire/area '
  lacks out 'mutants/'
  expect 0 --version
  expect 0 --help
}

"$3"
