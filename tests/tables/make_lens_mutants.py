#!/usr/bin/python3
"""Means of broken lens integration at one pixel: prints tests/tables/lens_mutants.csv.

Integrals over the lens are scipy's; means of rules that look at their own samples are sums over all
ways in which lens samples of an edge, lit with probability p, can fall.
"""
import math

from scipy import integrate, special

NOISE = .11


def coverage(d):
    return 1 - (math.acos(d) - d * math.sqrt(1 - d * d)) / math.pi


def wanted(lit, count):
    """Samples that the rule asks for when `lit` of `count` are lit: s^2 / noise^2, rounded up."""
    return max(1, math.ceil(lit * (count - lit) / count / (count - 1) / NOISE ** 2))


def reused(p, pilot):
    """The pilot averaged with as many more as make up the number that it asks for."""
    total = 0
    for k in range(pilot + 1):
        n = max(pilot, wanted(k, pilot))
        total += special.binom(pilot, k) * p ** k * (1 - p) ** (pilot - k) * (
            k + (n - pilot) * p) / n
    return total


def stopped(p, pilot):
    """Samples drawn until there are as many as they themselves ask for, state by state."""
    alive = {k: special.binom(pilot, k) * p ** k * (1 - p) ** (pilot - k)
             for k in range(pilot + 1)}
    count, total = pilot, 0
    while alive:
        further = {}
        for k, probability in alive.items():
            if count >= wanted(k, count):
                total += probability * k / count
                continue
            for lit, chance in ((k, 1 - p), (k + 1, p)):
                further[lit] = further.get(lit, 0) + probability * chance
        alive, count = further, count + 1
    return total


# The mutant takes the radius xi and not its root. Beyond r = t the lit part of a circle of radius r
# is 1 - acos(t / r) / pi.
t = .5
crowded = 1 - integrate.quad(lambda r: math.acos(t / r) / math.pi, t, 1, epsabs=1e-13)[0]
# The wave 1/2 + 1/2 cos(15 x) of `sinusoid` at depth 4 over a disc of radius 0.1, not 0.2.
z = 15 * .2 * (4 - 2) / 4
p = coverage(-.7)
print("# /usr/bin/python3 tests/tables/make_lens_mutants.py > tests/tables/lens_mutants.csv")
print("mutant,parameters,mean,sound")
pilot = f"{{scene: edge; pixel: [0.14; 0]; pilot: 4; noise: {NOISE}}}"
for name, parameters, mean, sound in (
        ("lens_crowded", "{scene: edge; pixel: [-0.1; 0]}", crowded, coverage(t)),
        ("lens_blur_by_depth", "{scene: sinusoid; pixel: [0; 0]}", .5 + special.j1(z) / z,
         .5 + special.j1(3) / 3),
        ("lens_pilot_reused", pilot, reused(p, 4), p),
        ("lens_stopped_by_error", pilot, stopped(p, 4), p)):
    print(f"{name},{parameters},{mean:.12g},{sound:.12g}")
