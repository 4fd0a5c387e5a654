#!/usr/bin/env python3
"""Wang and Tsiatis's constants: a Brownian motion on 1601 even points a look, Simpson's rule.

The program integrates scores by Gauss and Legendre's rule, so the two share nothing.

    python3 tests/tables/make_boundary.py > tests/tables/boundary.csv
"""
import numpy as np
from scipy.optimize import brentq
from scipy.stats import norm

POINTS = 1601
CASES = [
    (2, "even", 0.5, 0.005), (5, "even", 0.5, 0.025), (5, "even", 0.0, 0.005),
    (10, "even", 0.0, 0.005), (10, "even", 0.5, 0.005), (10, "even", 0.25, 0.01),
    (10, "root", 0.25, 0.1), (10, "root", 0.25, 0.01), (10, "root", 0.25, 0.005),
    (10, "root", 0.25, 1e-4), (10, "root", 0.25, 1e-6), (10, "root", 0.25, 1e-9),
    (16, "root", 0.25, 0.01), (5, "double", 0.25, 1e-5), (4, "close", 0.25, 0.02),
]


def times_of(looks, growth):
    steps = np.arange(1, looks + 1)
    return {"even": steps / looks, "root": 2.0 ** ((steps - looks) / 2),
            "double": 2.0 ** (steps - looks), "close": np.array([0.2, 0.21, 0.95, 1.0])}[growth]


def grid(low, high):
    at = np.linspace(low, high, POINTS)
    weights = np.ones(POINTS)
    weights[1:-1:2] = 4
    weights[2:-1:2] = 2
    return at, weights * (at[1] - at[0]) / 3


def crossing(times, scores):
    bounds = scores * np.sqrt(times)
    total = norm.sf(scores[0])
    at, weights = grid(-9 * np.sqrt(times[0]), min(bounds[0], 12 * np.sqrt(times[0])))
    mass = norm.pdf(at, scale=np.sqrt(times[0])) * weights
    for k in range(1, len(times)):
        deviation = np.sqrt(times[k] - times[k - 1])
        total += np.sum(mass * norm.sf((bounds[k] - at) / deviation))
        if k + 1 == len(times):
            return total
        to, weights = grid(-9 * np.sqrt(times[k]), min(bounds[k], 12 * np.sqrt(times[k])))
        kernel = norm.pdf(to[:, None], loc=at[None, :], scale=deviation)
        at, mass = to, (kernel @ mass) * weights
    return total


def constant(times, level, delta):
    shape = times ** (delta - 0.5)
    return brentq(lambda c: np.log(crossing(times, c * shape) / level), norm.isf(level) - 0.05,
                  norm.isf(level / len(times)) + 0.5, xtol=1e-11)


print("# python3 tests/tables/make_boundary.py")
print("looks,growth,delta,level,constant")
for looks, growth, delta, level in CASES:
    print(f"{looks},{growth},{delta},{level},{constant(times_of(looks, growth), level, delta):.9f}")
