#!/usr/bin/env python3
"""How many samples find a bug: with Assay, and with what people do today.

    python3 tests/compare_today.py --assay build/harness/assay [--seeds 10] [ROW ...]

It needs numpy and scipy. A row is a mutant of the catalogue, or a sound estimator, on which each finding is a false
alarm. Each rule judges it under seeds 1 to SEEDS. The rules are written anew, from what their authors publish:

  Assay    one claim at level .01; it chooses the number of samples, and its pilot counts; `assay images` of pictures
  Welch    scipy's ttest_ind beside the sound estimator, at .05; of pictures per pixel, at Sidak's level over the pixels
  Mitsuba  the chi-square test of a sampler: 50 x 101 cells, a trapezoid rule of 4 x 4 points a cell, small cells joined
           until 5 are expected, level .01; it refuses a density whose total exceeds 1.1
  Nori     Student's t test against the closed form, at .01
  RMSE     a finding if the mean picture is 10 % farther from a converged one than that of a sound renderer

Samples of the rules grow until all seeds find the bug: the cell has that number, or the seeds that find it with the last
one. Sound rows take the usual numbers. Pictures are 64 a side, and their samples are those of a pixel.
tests/measurements.md has the results. The study takes some minutes.
"""

import argparse
import dataclasses
import functools
import json
import subprocess
import tempfile

import numpy
import scipy.stats

NAMES = ("Assay", "Welch", "Mitsuba", "Nori", "RMSE")
LADDER = (100, 1_000, 10_000, 100_000)
USUAL = {"Welch": 10_000, "Nori": 100_000, "Mitsuba": 1_000_000}
PILOT = 16_384, 8_192  # of an estimator that averages, of a sampler (harness/pilot/pilot.cpp)
PICTURES, PRIMARIES, USUAL_PRIMARIES = 64, (1, 4, 16, 64), 8
CONVERGED = 3200  # primaries of each of 64 pictures that RMSE is taken against


@dataclasses.dataclass
class Row:
    bug: str
    new: str  # a plugin with its parameters
    old: str
    claim: str  # what a user of Assay claims
    detect: str  # and the effect that must not pass, or None
    density: object = None  # of the sampler `direction`, as declared
    picture: bool = False

    @property
    def sound(self):
        return self.new == self.old


def ward(directions, jacobian=True):
    """Ward's density as declared: of roughness .15 and .4, seen from theta .8, phi .5 (Walter 2005, eq. 9)."""
    ax, ay, theta, phi = .15, .4, .8, .5
    incident = numpy.array([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)])
    h = directions + incident
    h /= numpy.linalg.norm(h, axis=-1, keepdims=True)
    cosine = numpy.maximum(h[..., 2], 1e-3)
    exponent = ((h[..., 0] / ax) ** 2 + (h[..., 1] / ay) ** 2) / cosine ** 2
    density = numpy.exp(-exponent) / (numpy.pi * ax * ay * cosine ** 3)
    if jacobian:
        density = density / (4 * (h @ incident))
    return numpy.where(directions[..., 2] > 0, density, 0)


class Program:
    def __init__(self, path):
        self.path = path
        self.means = {}
        self.converged = {}

    def run(self, *arguments):
        run = subprocess.run([self.path, *arguments], capture_output=True, text=True)
        if run.returncode not in (0, 1, 3):
            raise RuntimeError(run.stderr)
        return run.stdout

    @functools.lru_cache(maxsize=64)
    def sample(self, plugin, count, seed, primaries=1, part=""):
        text = self.run("sample", "it" + part, "--estimator", "it=" + plugin, "--seed", str(seed), "--secondaries",
                        str(count), "--primaries", str(primaries))
        numbers = " ".join(line for line in text.split("\n") if not line.startswith("#"))
        return numpy.fromstring(numbers, sep=" ").reshape(count, -1)

    def mean(self, plugin):
        """The closed form, as the catalogue knows it."""
        if plugin not in self.means:
            claim = self.run("check", "mean(it) == analytic", "--estimator", "it=" + plugin, "--secondaries", "2",
                             "--primaries", "1", "--report", "json=-", "console=/dev/null", "--quiet")
            text = json.loads(claim)["suites"][0]["tests"][0]["null_hypothesis"]
            self.means[plugin] = float(text.split("=")[-1])
        return self.means[plugin]

    def verdict(self, *arguments):
        record = json.loads(self.run(*arguments, "--report", "json=-", "console=/dev/null", "--quiet"))
        test = record["suites"][0]["tests"][0]
        return test["verdict"] == "fail", test["samples"]

    def check(self, row, seed):
        """Whether Assay finds something, and the samples of all sides with their pilots."""
        words = ["check", row.claim, "--estimator", "new=" + row.new, "--seed", str(seed)]
        if "old" in row.claim:
            words += ["--estimator", "old=" + row.old]
        if row.detect:
            words += ["--detect", row.detect]
        found, samples = self.verdict(*words)
        pilot = PILOT["direction" in row.claim]
        return found, sum(side["secondaries"] * side["primaries"] + pilot for side in samples)

    def images(self, new, old, seed):
        with tempfile.TemporaryDirectory() as folder:
            for name, pictures in (("new", new), ("old", old)):
                for number, picture in enumerate(pictures):
                    write_pfm(f"{folder}/{name}{number}.pfm", picture)
            return self.verdict("images", "--candidate", folder + "/new*.pfm", "--reference", folder + "/old*.pfm",
                                "--seed", str(seed))[0]


def write_pfm(path, picture):
    """A picture of the size of its channels: 32 x 32 of one number, 32 x 24 of three."""
    colours = 1 if picture.size == 32 * 32 else 3
    with open(path, "wb") as file:
        file.write(f"{'Pf' if colours == 1 else 'PF'}\n32 {picture.size // 32 // colours}\n-1\n".encode())
        file.write(picture.reshape(-1, 32 * colours)[::-1].astype("<f4").tobytes())


# Each rule: whether it finds something in so many samples.


def mitsuba(program, row, size, seed):
    angles = program.sample(row.new, size, seed, part=".direction")
    angles = angles[angles[:, 0] >= 0]  # a draw without a point has weight 0
    columns, rows, points = 50, 101, 4
    phi = (angles[:, 1] + numpy.pi) % (2 * numpy.pi)
    at = (numpy.minimum((1 - numpy.cos(angles[:, 0])) / 2 * rows, rows - 1).astype(int),
          numpy.minimum(phi / (2 * numpy.pi) * columns, columns - 1).astype(int))
    observed = numpy.zeros((rows, columns))
    numpy.add.at(observed, at, 1)
    height, width = 2 / rows, 2 * numpy.pi / columns
    inner = (numpy.arange(points) + 1e-4) * (1 - 2e-4) / (points - 1)
    weight = numpy.where(numpy.arange(points) % (points - 1) == 0, .5, 1) / (points - 1)
    cosine = 1 - (numpy.arange(rows)[:, None, None, None] + inner[:, None, None]) * height
    phi = -numpy.pi + (numpy.arange(columns)[:, None] + inner) * width
    sine = numpy.sqrt(numpy.maximum(1 - cosine ** 2, 0))
    directions = numpy.stack(numpy.broadcast_arrays(sine * numpy.cos(phi), sine * numpy.sin(phi), cosine), axis=-1)
    expected = numpy.einsum("ricj,i,j->rc", row.density(directions), weight, weight) * height * width * size
    if expected.sum() > 1.1 * size or ((expected == 0) & (observed > 0)).any():
        return True
    statistic, cells, joined, counted = 0, 0, 0, 0
    for i in numpy.argsort(expected, axis=None):
        joined, counted = joined + expected.flat[i], counted + observed.flat[i]
        # Small cells are joined until 5 are expected.
        if joined > 5 or expected.flat[i] >= 5:
            statistic, cells = statistic + (counted - joined) ** 2 / joined, cells + 1
            joined, counted = 0, 0
    return cells > 1 and scipy.stats.chi2.sf(statistic, cells - 1) < .01


def nori(program, row, size, seed):
    values = program.sample(row.new, size, seed)[:, 0]
    t = abs(values.mean() - program.mean(row.old)) / numpy.sqrt(max(values.var(ddof=1), 1e-5) / size)
    return 2 * scipy.stats.t.sf(t, size - 1) < .01


def sides(program, row, size, seed):
    """New and old. A mutant takes its original's random numbers, so that the sound side needs another seed."""
    count, primaries = (PICTURES, size) if row.picture else (size, 1)
    return [program.sample(plugin, count, place, primaries) for plugin, place in ((row.new, seed), (row.old, 1000 + seed))]


def images(program, row, size, seed):
    return program.images(*sides(program, row, size, seed), seed)


def welch(program, row, size, seed):
    new, old = sides(program, row, size, seed)
    varies = (new.var(axis=0) > 0) & (old.var(axis=0) > 0)
    p = scipy.stats.ttest_ind(new[:, varies], old[:, varies], equal_var=False).pvalue
    same = numpy.allclose(new[:, ~varies].mean(axis=0), old[:, ~varies].mean(axis=0))
    return not same or p.min() < 1 - .95 ** (1 / new.shape[1])


def rmse(program, row, size, seed):
    if row.old not in program.converged:
        program.converged[row.old] = program.sample(row.old, PICTURES, 5000, CONVERGED).mean(axis=0)
    errors = [numpy.sqrt(((side.mean(axis=0) - program.converged[row.old]) ** 2).mean())
              for side in sides(program, row, size, seed)]
    return errors[0] > 1.1 * errors[1]


def rules(row):
    """Rules that can judge it, each with its numbers of samples."""
    if row.picture:
        sizes = (USUAL_PRIMARIES,) if row.sound else PRIMARIES
        return {"Assay": (images, sizes), "Welch": (welch, sizes), "RMSE": (rmse, sizes)}
    able = {"Welch": welch, "Nori": nori} | ({"Mitsuba": mitsuba} if row.density else {})
    return {name: (rule, (USUAL[name],) if row.sound else (*LADDER, USUAL["Mitsuba"]) if rule is mitsuba else LADDER) for name, rule in able.items()}


def of_assay(program, row, seeds):
    results = [program.check(row, seed) for seed in seeds]
    return sum(found for found, _ in results), sum(samples for _, samples in results) / len(results)


def of_rule(program, row, rule, sizes, seeds):
    for size in sizes:
        found = sum(bool(rule(program, row, size, seed)) for seed in seeds)
        if found == len(seeds):
            break
    return found, size * PICTURES if row.picture else 2 * size if rule is welch else size


def rows():
    unbiased = "mean(new) == analytic"
    alike = "mean(new) == mean(old)"
    sampler = "distribution(new.direction) == density"
    weights = "inconsistency(new.direction) == 0"
    light = ("scene={receiver: {position: [0, 0, 0], normal: [0, 0, 1]}, light: {polygon: [[1.6437, -0.3, 1.1782], [1.6437, "
             "0.3, 1.1782], [1.2257, 0.3, 1.6086], [1.2257, -0.3, 1.6086]], radiance: 1}},"
             "brdf={ashikhmin_shirley: {nu: 1000, nv: 100, theta_i: 0.8, phi_i: 3.1416}}")

    def no_jacobian(directions):
        return ward(directions, jacobian=False)

    def of_ward(bug, mutant, claim, detect, density=ward):
        return Row(bug, mutant, "brdf/ward", claim, detect, density)

    def of_paths(bug, mutant, scene):
        return Row(bug, f"{mutant},scene={scene}", f"path_tracing/image,scene={scene}", alike, None, picture=True)

    return {
        "one_percent": Row("result 1 % too large", "mutants/one_percent", "luminaire/area", unbiased, "0.8%"),
        "jacobian": of_ward("density without the half-vector Jacobian", "mutants/ward_no_jacobian", sampler, "0.05",
                            no_jacobian),
        "redrawn": of_ward("draws below the horizon drawn again", "mutants/ward_redrawn", sampler, "0.01"),
        "cosine": of_ward("weight without its cosine", "mutants/ward_weight_without_cosine", weights, None),
        "sector": of_ward("declared density 0.1 % off in a sector", "mutants/ward_density_sector", weights, "0.005"),
        "weights": Row("weights of multiple importance sampling exchanged", "mutants/weights_exchanged," + light,
                       "direct_light/multi_sample," + light, "variance(new) <= variance(old)", "20%"),
        "tile": Row("an 8 x 8 tile 2 % too bright", "mutants/floor_tile", "luminaire/floor", alike, None, picture=True),
        "light_density": of_paths("density of points on lights 5 % off", "mutants/paths_light_density", "box"),
        "pixel": of_paths("one dead pixel", "mutants/paths_dead_pixel", "box"),
        "roulette": of_paths("Russian roulette without compensation", "mutants/paths_roulette", "box"),
        "clamp": of_paths("bright paths clamped", "mutants/paths_clamp,amount=5", "glass"),
        "sound_area": Row("none: a sound estimator", "luminaire/area", "luminaire/area", unbiased, "0.8%"),
        "sound_ward": of_ward("none: a sound sampler", "brdf/ward", sampler, "0.05"),
        "sound_glass": of_paths("none: a sound path tracer with fireflies", "path_tracing/image", "glass"),
    }


def cell(row, result, seeds):
    if result is None:
        return "–"
    found, samples = result
    if found == len(seeds) and not row.sound:
        return f"{samples:,.0f}"
    return f"{found} of {len(seeds)} with {samples:,.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--assay", required=True)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("row", nargs="*")
    given = parser.parse_args()
    program = Program(given.assay)
    seeds = range(1, given.seeds + 1)
    print("| bug | " + " | ".join(NAMES) + " |\n" + "|---" * (len(NAMES) + 1) + "|")
    for name, row in rows().items():
        if given.row and name not in given.row:
            continue
        able = rules(row)
        results = [of_rule(program, row, *able[rule], seeds) if rule in able else None for rule in NAMES]
        if not row.picture:
            results[0] = of_assay(program, row, seeds)
        print(f"| {row.bug} | " + " | ".join(cell(row, result, seeds) for result in results) + " |", flush=True)


if __name__ == "__main__":
    main()
