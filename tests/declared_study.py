#!/usr/bin/env python3
"""Verdicts on estimators and samplers that break what they declare, and on sound ones beside them.

    python3 tests/declared_study.py --assay build/harness/assay [--seeds 100] [--first 1] [CASE ...]

Each case is a small library for the plugin `library`, compiled by gcc. A row has its name, the claim and how often each
verdict came. harness/measurements.md has the results.
"""

import argparse
import collections
import json
import pathlib
import subprocess
import tempfile

HEAD = r"""
#include <math.h>
#include "plugin_abi.h"
static double normal(AssayStream* s) {
  double u = assay_uniform(s), v = assay_uniform(s);
  return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * v);
}
static double normal_at(uint64_t key, uint64_t index) {
  AssayStream s = assay_stream(key, index);
  return normal(&s);
}
"""

ESTIMATOR = HEAD + r"""
static double primary(AssayStream* s) { return %(primary)s; }
static double mean_of(AssayStream* s, uint64_t primaries) {
  double sum = 0;
  for (uint64_t k = 0; k < primaries; ++k) sum += primary(s);
  return sum / (double)primaries;
}
static int secondary(AssayCall* call) {
  AssayStream* s = call->random;
  uint64_t key = (uint64_t)s->key[1] << 32 | s->key[0];
  uint64_t i = (uint64_t)s->counter[3] << 32 | s->counter[2];
  uint64_t n = call->primaries;
  double x = 0;
  (void)key, (void)i, (void)n;
  %(observation)s
  call->out[0] = x;
  return 0;
}
static const AssayChannel channel = {.size = sizeof channel, .name = "value"};
static const AssayEstimator estimator = {.size = sizeof estimator, .name = "mine", .flags = %(flags)s,
    .channels = &channel, .channel_count = 1, .secondary = secondary};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &estimator, 1};
const AssayLibrary* assay_library(void) { return &library; }
"""

SAMPLER = HEAD + r"""
static double peak(double x, double mean, double sd) {
  return exp(-.5 * (x - mean) * (x - mean) / sd / sd) / sd / 2.5066282746310002;
}
static double density(const void* setup, const double p[3]) { (void)setup, (void)peak; return %(density)s; }
static int sample(const void* setup, AssayStream* s, AssayDraw* draw) {
  double u = assay_uniform(s), v = assay_uniform(s), w = assay_uniform(s);
  double* p = draw->point;
  (void)u, (void)v, (void)w;
  p[0] = p[1] = p[2] = 0;
  %(draw)s
  draw->density = density(setup, p);
  draw->weight = 1;
  return 0;
}
static int secondary(AssayCall* call) { call->out[0] = assay_uniform(call->random); return 0; }
static const AssaySampler sampler = {.size = sizeof sampler, .name = "draw", .domain = %(domain)s, .low = 0,
    .high = 1, .sample = sample, .density = density, .evaluate = density};
static const AssayChannel channel = {.size = sizeof channel, .name = "value"};
static const AssayEstimator estimator = {.size = sizeof estimator, .name = "mine", .channels = &channel,
    .channel_count = 1, .secondary = secondary, .samplers = &sampler, .sampler_count = 1};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &estimator, 1};
const AssayLibrary* assay_library(void) { return &library; }
"""

LAWS = {"normal": "3 + normal(s)", "lognormal(0, 2)": "exp(2 * normal(s))",
        "pareto 2.1": "pow(1 - assay_uniform(s), -1 / 2.1)", "spike 1e-3": "assay_uniform(s) < 1e-3 ? 500 : .5"}
MEAN, VARIANCE = ("mean(mine) == 3", "--detect=0.05"), ("variance(mine) == 1", "--detect=20%")
ORDERED = [MEAN, ("mean(mine) == 3", "--detect=0.05", "--test=t"), ("variance(mine) == 2", "--detect=10%"),
           ("quantile(mine, 0.5) == 3", "--detect=0.05"), ("distribution(mine) == normal(3, 1)", "--detect=0.1")]
FIT = [("distribution(mine.draw) == density",)]
FINE = [*FIT, ("distribution(mine.draw) == density", "--detect=0.02")]


def estimator(observation, claims, law="normal", averages=False):
    return ESTIMATOR % {"primary": LAWS[law], "observation": observation,
                        "flags": "ASSAY_AVERAGES" if averages else "0"}, claims


def sampler(density, draw, claims=FIT, square=False):
    return SAMPLER % {"density": density, "draw": draw, "domain": "ASSAY_SQUARE" if square else "ASSAY_INTERVAL"}, claims


def shared(block, share):
    return f"x = 3 + normal_at(key, i) + {share} * normal_at(key ^ 0x5555, i / {block});"


def cases():
    all_ = {
        "moving average of 5": estimator("for (int j = 0; j < 5; ++j) x += normal_at(key, i + j); x += 3;", ORDERED),
        "chain, phi .5": estimator("double f = 1; for (uint64_t j = 0; j < 40 && j <= i; ++j, f /= 2) "
                                   "x += f * normal_at(key, i - j); x += 3;", ORDERED),
        "8 share an offset of .5 sd": estimator(shared(8, .5), ORDERED),
        "256 share an offset of .25 sd": estimator(shared(256, .25), ORDERED),
        "independent": estimator("x = 3 + normal_at(key, i);", ORDERED[:2]),
        "primaries are a chain, phi .9": estimator(
            "double c = 0; for (uint64_t k = 0; k < n; ++k) { c = .9 * c + primary(s) - 3; x += c; } x = 3 + x / n;",
            [VARIANCE], averages=True),
        "ignores the key": estimator("AssayStream t = assay_stream(77, i); x = mean_of(&t, n);", [MEAN], averages=True),
        "ignores the key, spike 1e-3": estimator("AssayStream t = assay_stream(77, i); x = mean_of(&t, n);",
                                                 [("mean(mine) == 0.9995", "--detect=10%")], "spike 1e-3", True),
        "ignores the index": estimator("AssayStream t = assay_stream(key, 77); x = mean_of(&t, n);", [MEAN],
                                       averages=True),
        "has a state of its own": estimator("static uint64_t calls; AssayStream t = assay_stream(5, calls++); "
                                            "x = mean_of(&t, n);", [MEAN], averages=True),
        "multiples of 2^-7": sampler("1", "p[0] = floor(128 * u) / 128;", FINE),
        "checkerboard 64 x 64": sampler("1", "int i = 64 * u, j = 64 * v; j ^= (i + j) & 1; p[0] = (i + w) / 64; "
                                        "p[1] = (j + assay_uniform(s)) / 64;", FINE, True),
        "peak of 2e-5": sampler("peak(p[0], .3456789, 2e-5)", "p[0] = .3456789 + 2e-5 * normal(s);", FINE),
        "peaks of 2e-5 and 1e-4": sampler(
            "(peak(p[0], .3456789, 2e-5) + peak(p[0], .9, 1e-4)) / 2",
            "p[0] = u < .5 ? .3456789 + 2e-5 * normal(s) : .9 + 1e-4 * normal(s);", FINE),
        "peak of 2e-5 x 3e-5": sampler("peak(p[0], .3456789, 2e-5) * peak(p[1], .7, 3e-5)",
                                       "p[0] = .3456789 + 2e-5 * normal(s); p[1] = .7 + 3e-5 * normal(s);", FIT, True),
        "sharp edge, floats": sampler("p[0] < 1 / 3. ? 3 : 0", "p[0] = (float)(1 / 3.) * (float)u;", FINE),
        "uniform": sampler("1", "p[0] = u; p[1] = v;", FINE, True),
    }
    for law in LAWS:
        all_[f"averages, {law}"] = estimator("x = mean_of(s, n);", [("mean(mine) >= 0",)], law, True)
        all_[f"one primary, {law}"] = estimator("x = primary(s);", [("variance(mine) == 1", "--detect=20%")], law, True)
    for leak in (0, .01, .001, .0001):
        all_[f"disc, leak {leak:g}"] = sampler(
            "pow(p[0] - .5, 2) + pow(p[1] - .5, 2) < .16 ? 1 / (.16 * 3.141592653589793) : 0",
            f"double r = w < {leak} ? .4 + .1 * u : .4 * sqrt(u); p[0] = .5 + r * cos(6.283185307179586 * v); "
            "p[1] = .5 + r * sin(6.283185307179586 * v);",
            [("distribution(mine.draw) == density", f"--detect={detect}") for detect in (.05, .1)], True)
    return all_


def verdicts(assay, library, claim, seeds):
    counts = collections.Counter()
    for seed in seeds:
        said = subprocess.run([assay, "check", claim[0], *claim[1:], "--estimator", f"mine=library,file={library}",
                               "--seed", str(seed), "--report", "json=-"], capture_output=True, text=True, check=False)
        counts[json.loads(said.stdout)["suites"][0]["tests"][0]["verdict"]] += 1
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assay", default="build/harness/assay")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("case", nargs="*")
    options = parser.parse_args()
    include = pathlib.Path(__file__).resolve().parent.parent / "estimators"
    with tempfile.TemporaryDirectory() as folder:
        for name, (source, claims) in cases().items():
            if options.case and name not in options.case:
                continue
            code = pathlib.Path(folder, "mine.c")
            library = pathlib.Path(folder, f"mine{abs(hash(name))}.so")
            code.write_text(source)
            subprocess.run(["gcc", "-std=c11", "-O2", "-fPIC", "-shared", "-w", "-I", include, code, "-o", library, "-lm"],
                           check=True)
            for claim in claims:
                seeds = range(options.first, options.first + options.seeds)
                found = verdicts(options.assay, library, claim, seeds)
                print(f"| {name} | `{' '.join(claim)}` | "
                      + ", ".join(f"{count} {verdict}" for verdict, count in sorted(found.items())) + " |", flush=True)


if __name__ == "__main__":
    main()
