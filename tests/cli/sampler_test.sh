#!/usr/bin/env bash
# Samplers of a shared library, in a process of their own and in the run's. TEST is one of the
# functions test_… below.
#   sampler_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
source "$(dirname "$0")/foreign.sh"

# library NAME [OF_SAMPLE [OF_DENSITY [OF_EVALUATE]]] writes a library whose functions begin with
# these statements. Its samplers are `cosine` (directions), `disc` (a jump on a square, with draws
# that yield no point) and `ramp` (an interval).
library() {
  cat >"$1.c" <<SOURCE
#include "plugin_abi.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>
#define PI 3.14159265358979323846
#define HEIGHT (1 / (PI * .16))
typedef const void *Setup;
static int draw_direction(Setup setup, AssayStream *random, AssayDraw *draw) {
  const double u = assay_uniform(random), turn = 2 * PI * assay_uniform(random);
  const uint32_t index = random->counter[2] & 1023;
  (void)setup, (void)index;
  ${2:-}
  draw->point[0] = sqrt(u) * cos(turn);
  draw->point[1] = sqrt(u) * sin(turn);
  draw->point[2] = sqrt(1 - u);
  draw->density = draw->point[2] / PI;
  draw->weight = PI;
  return 0;
}
static double of_direction(Setup setup, const double *p) { (void)setup; ${3:-} return p[2] / PI; }
static double cosine(Setup setup, const double *p) { (void)setup; ${4:-} return p[2]; }
static int draw_place(Setup setup, AssayStream *random, AssayDraw *draw) {
  const double r = .4 * sqrt(assay_uniform(random)), turn = 2 * PI * assay_uniform(random);
  (void)setup;
  if (assay_uniform(random) < .25) return draw->no_point = 1, 0;
  draw->point[0] = .5 + r * cos(turn);
  draw->point[1] = .5 + r * sin(turn);
  draw->density = .75 * HEIGHT;
  draw->weight = 2;
  return 0;
}
static double of_place(Setup setup, const double *p) {
  (void)setup;
  return hypot(p[0] - .5, p[1] - .5) < .4 ? .75 * HEIGHT : 0;
}
static double twice(Setup setup, const double *p) { return 2 * of_place(setup, p); }
static int draw_number(Setup setup, AssayStream *random, AssayDraw *draw) {
  const double a = assay_uniform(random), b = assay_uniform(random);
  (void)setup;
  draw->point[0] = a > b ? a : b;
  draw->density = 2 * draw->point[0];
  draw->weight = 1 / draw->density;
  return 0;
}
static double of_number(Setup setup, const double *p) { (void)setup; return 2 * p[0]; }
static double one(Setup setup, const double *p) { (void)setup, (void)p; return 1; }
static const AssaySampler samplers[] = {
    {.size = sizeof samplers[0], .name = "cosine", .domain = ASSAY_HEMISPHERE,
     .sample = draw_direction, .density = of_direction, .evaluate = cosine},
    {.size = sizeof samplers[0], .name = "disc", .domain = ASSAY_SQUARE,
     .sample = draw_place, .density = of_place, .evaluate = twice},
    {.size = sizeof samplers[0], .name = "ramp", .domain = ASSAY_INTERVAL, .low = 0, .high = 1,
     .sample = draw_number, .density = of_number, .evaluate = one}};
static int secondary(AssayCall *call) { call->out[0] = assay_uniform(call->random); return 0; }
static const AssayChannel x = {.size = sizeof x, .name = "x"};
static const AssayEstimator mine = {.size = sizeof mine, .name = "mine", .channels = &x,
    .channel_count = 1, .secondary = secondary, .samplers = samplers, .sampler_count = 3};
static const AssayLibrary table = {sizeof table, ASSAY_ABI_VERSION, &mine, 1};
const AssayLibrary *assay_library(void) { return &table; }
SOURCE
  compile "$1.c" -lm
}

# claims FILE LIBRARY [MORE]: every kind of claim on a sampler.
claims() {
  cat >"$1" <<SUITE
suite: samplers
estimators:
  mine: {plugin: library, file: $2.so${3:-}}
tests:
  - {claim: distribution(mine.cosine) == density, detect: 0.02}
  - {claim: distribution(mine.cosine.theta) == density}
  - {claim: integral(mine.cosine) == 1, detect: 0.001}
  - {claim: inconsistency(mine.cosine) == 0, detect: 0.001}
  - {claim: distribution(mine.disc) == density}
  - {claim: distribution(mine.disc.u) == density}
  - {claim: inconsistency(mine.disc) == 0}
  - {claim: distribution(mine.ramp) == density}
  - {claim: distribution(mine.ramp.x) == density}
  - {claim: inconsistency(mine.ramp) == 0}
SUITE
}

test_samplers_of_a_library_pass_their_claims_in_any_process() {
  library mine
  claims mine.yaml mine
  expect 0 run mine.yaml --report json=one.json --threads 1
  expect 0 run mine.yaml --report json=two.json --threads 2
  same_records one.json two.json || fail 'threads change the record'
  claims mine.yaml mine ', isolated: false'
  expect 0 run mine.yaml --report json=inside.json --threads 2
  same_records one.json inside.json || fail 'isolation changes the record'
  expect 0 replay one.json 'mine/distribution(mine.cosine) == density'
  tells out 'the same numbers as recorded'
  expect 0 sample mine.cosine --estimator mine=library,file=mine.so --secondaries 5000
  tail -n +2 out >isolated.txt
  expect 0 sample mine.cosine --estimator mine=library,file=mine.so,isolated=false \
    --secondaries 5000
  cmp isolated.txt <(tail -n +2 out) || fail 'the draws differ'
  none_left
}

test_a_wrong_density_of_a_library_fails() {
  library steeper '' 'return 2 * p[2] * p[2] / PI * .75;' 'return 1.5 * p[2] * p[2];'
  claims wrong.yaml steeper
  expect 1 run wrong.yaml --filter '*cosine*' --report json=run.json
  contains out 'note: farthest off in'
  contains out 'note: the draw has density 0.'
  verdict_is run.json 'distribution(mine.cosine) == density' fail
  verdict_is run.json 'distribution(mine.cosine.theta) == density' fail
  verdict_is run.json 'inconsistency(mine.cosine) == 0' fail
  verdict_is run.json 'integral(mine.cosine) == 1' pass
  message run.json 'inconsistency(mine.cosine) == 0'
  tells err ', first at observation 0'
  none_left
}

test_a_density_below_zero_is_invalid() {
  library negative '' 'return p[2] - .5;'
  claims negative.yaml negative
  expect 1 run negative.yaml --report json=run.json
  local quantity
  for quantity in 'distribution(mine.cosine)' 'distribution(mine.cosine.theta)'; do
    verdict_is run.json "$quantity == density" invalid
    message run.json "$quantity == density"
    tells err 'must be non-negative and finite'
  done
  verdict_is run.json 'integral(mine.cosine) == 1' invalid
  verdict_is run.json 'distribution(mine.disc) == density' pass
}

# Points, lengths and densities that no claim can be about, where all else agrees with them.
test_draws_that_are_unsound_are_errors_in_every_claim() {
  library long 'draw->point[0] = draw->point[1] = draw->point[2] = 1;
    return draw->density = 1 / PI, draw->weight = PI, 0;'
  library below 'if (index % 256 == 5) return draw->point[2] = -1, draw->weight = PI, 0;'
  library negative 'draw->point[2] = 1; return draw->density = -.25, 0;'
  local isolated name
  for isolated in true false; do
    for name in long below negative; do
      cat >unsound.yaml <<SUITE
suite: unsound
estimators:
  mine: {plugin: library, file: $name.so, isolated: $isolated}
tests:
  - {name: law, claim: distribution(mine.cosine) == density}
  - {name: theta, claim: distribution(mine.cosine.theta) == density}
  - {name: integral, claim: integral(mine.cosine) == 1}
  - {name: drawn, claim: inconsistency(mine.cosine) == 0}
  - {name: other, claim: distribution(mine.ramp) == density}
SUITE
      expect 1 run unsound.yaml --report json="$name.json"
      verdict_is "$name.json" other pass
      local claim
      for claim in law theta integral drawn; do
        verdict_is "$name.json" "$claim" error
        message "$name.json" "$claim"
        tells err '`mine` stopped at observation '
        case $name in
          long) tells err ': sampler `cosine` drew (1, 1, 1), whose length is 1.73' ;;
          below) tells err ': sampler `cosine` drew (0, 0, -1), outside its hemisphere (z >= 0)' ;;
          negative) tells err ': sampler `cosine` drew (0, 0, 1) with density -0.25: ' ;;
        esac
      done
    done
  done
  none_left
}

# broken NAME…: a suite of a library each, whose `cosine` breaks, and of a sound sampler.
broken() {
  local name
  {
    printf '%s\n' 'suite: broken' 'estimators:' '  sound: {plugin: library, file: sound.so}'
    for name in "$@"; do
      printf '  %s: {plugin: library, file: %s.so, timeout: 1.5}\n' "$name" "$name"
    done
    printf '%s\n' 'tests:' '  - {name: sound, claim: distribution(sound.cosine) == density}'
    for name in "$@"; do
      printf '  - {name: %s, claim: distribution(%s.cosine) == density}\n' "$name" "$name"
      printf '  - {name: %s drawn, claim: inconsistency(%s.cosine) == 0}\n' "$name" "$name"
      printf '  - {name: %s other, claim: distribution(%s.ramp) == density}\n' "$name" "$name"
    done
  } >broken.yaml
  expect 1 run broken.yaml --report json=run.json --threads 1
  expect 1 run broken.yaml --report json=two.json --threads 2
  same_records run.json two.json || fail 'threads change the record'
  verdict_is run.json sound pass
  for name in "$@"; do verdict_is run.json "$name other" pass; done
}

test_densities_that_break_are_errors_and_the_others_finish() {
  local at='if (p[2] < .3)'
  library sound
  library crashes '' "$at *(volatile int *)0 = 1;"
  library hangs '' "$at for (;;) thrd_sleep(&(struct timespec){3600, 0}, NULL);"
  library nothing '' "$at return NAN;"
  library prints '' "$at puts(\"grazing\");"
  library exits '' "$at _Exit(5);"
  broken crashes hangs nothing prints exits
  local name
  for name in crashes hangs nothing prints exits; do
    verdict_is run.json "$name" error
    verdict_is run.json "$name drawn" error
    message run.json "$name"
    tells err "the density that \`$name\` declares cannot be computed: sampler \`cosine\` at ("
    message run.json "$name drawn"
    tells err "\`$name\` stopped at observation "
    tells err 'sampler `cosine` at ('
  done
  message run.json crashes
  tells err 'was ended by signal 11 (Segmentation fault) instead of answering for 1 density'
  message run.json hangs
  tells err 'did not answer for 1 density within 1.5 seconds'
  message run.json nothing
  tells err 'density() is nan'
  message run.json prints
  tells err 'the library printed `grazing'
  message run.json exits
  tells err 'ended with exit status 5'
  expect 1 plan broken.yaml --filter '*/crashes'
  tells out 'error: the density that `crashes` declares cannot be computed'
  none_left
}

test_draws_that_break_are_errors_and_the_others_finish() {
  # One in 256: the index of the library's own stream is not the observation's.
  local at='if (index % 256 == 5)'
  library sound
  library crashes "$at *(volatile int *)0 = 1;"
  library hangs "$at for (;;) thrd_sleep(&(struct timespec){3600, 0}, NULL);"
  library nothing "$at return draw->density = NAN, 0;"
  library prints "$at puts(\"five\");"
  library reports "$at return 7;"
  broken crashes hangs nothing prints reports
  local name
  for name in crashes hangs nothing prints reports; do
    verdict_is run.json "$name" error
    verdict_is run.json "$name drawn" error
    message run.json "$name"
    tells err "\`$name\` stopped at observation "
    tells err ': sampler `cosine`: `'
  done
  message run.json crashes
  tells err 'was ended by signal 11 (Segmentation fault) instead of answering for 1 draw'
  message run.json hangs
  tells err 'did not answer for 1 draw within 1.5 seconds'
  message run.json nothing
  tells err ': sample() gave the point ('
  tells err 'density nan and weight'
  message run.json prints
  tells err 'the library printed `five'
  message run.json reports
  tells err ': status 7 of sample()'
  none_left
}

test_evaluations_that_break_are_errors_with_their_point() {
  library crashes '' '' 'if (p[2] < .3) *(volatile int *)0 = 1;'
  cat >broken.yaml <<'SUITE'
suite: broken
estimators:
  crashes: {plugin: library, file: crashes.so}
tests:
  - {name: density, claim: distribution(crashes.cosine) == density}
  - {name: drawn, claim: inconsistency(crashes.cosine) == 0}
SUITE
  expect 1 run broken.yaml --report json=run.json
  verdict_is run.json density pass
  verdict_is run.json drawn error
  message run.json drawn
  tells err 'instead of answering for 1 evaluation'
  tells err '`crashes` stopped at observation '
  none_left
}

"$3"
