#!/usr/bin/env python3
"""Levels of the skewness-corrected t test far in the tails, by importance sampling: values are drawn
from the exponentially tilted law whose mean has the critical T, and weighted back. Prints for both
sides the level over the nominal one, with its standard error, for the corrected and the plain test,
beside the value of residual_skewness_gate. Run: /usr/bin/python3 tests/stats/corrected_levels.py (four minutes)."""
from math import exp, log, sqrt

import numpy as np
from scipy import integrate, stats

rng = np.random.default_rng(1)
SIZES = (100, 200, 500, 1000, 4000)
LEVELS = (1e-3, 5e-7)


def exponential_tilt(lam, shape):
    return rng.exponential(1 / (1 - lam), shape)


def zero_inflated_tilt(lam, shape):
    share = 0.2 / (1 - lam)
    return (rng.random(shape) < share / (0.8 + share)) * exponential_tilt(lam, shape)


def lognormal_cgf(lam):
    def density(x):
        return exp(-2 * log(x) ** 2 + lam * x) / (0.5 * x * sqrt(2 * np.pi))
    return log(integrate.quad(density, 0, np.inf, limit=400)[0])


def lognormal_tilt(lam, shape):
    """By rejection; lam <= 0."""
    kept = np.empty(0)
    while len(kept) < np.prod(shape):
        x = rng.lognormal(0, 0.5, int(np.prod(shape) * 1.3))
        kept = np.concatenate([kept, x[rng.random(len(x)) < np.exp(lam * x)]])
    return kept[:np.prod(shape)].reshape(shape)


# name: mean, standard deviation, skewness, excess kurtosis, ln E exp(lam x), tilted draws, sides
LAWS = {
    "normal": (0, 1, 0, 0, lambda t: t * t / 2, lambda t, s: rng.standard_normal(s) + t, (-1, 1)),
    "exponential": (1, 1, 2, 6, lambda t: -log(1 - t), exponential_tilt, (-1, 1)),
    "uniform": (0.5, sqrt(1 / 12), 0, -1.2, lambda t: log((exp(t) - 1) / t),
                lambda t, s: np.log1p(rng.random(s) * np.expm1(t)) / t, (-1, 1)),
    "zero-inflated": (0.2, 0.6, 0.976 / 0.216, 3.9312 / 0.1296 - 3,
                      lambda t: log(0.8 + 0.2 / (1 - t)), zero_inflated_tilt, (-1, 1)),
    "lognormal(0.5)": (exp(0.125), sqrt(exp(0.25) * (exp(0.25) - 1)), 1.7502, 5.8984,
                       lognormal_cgf, lognormal_tilt, (-1,)),
}


def statistics(x, mean):
    n = x.shape[1]
    m = x.mean(1)
    d = x - m[:, None]
    m2 = (d * d).mean(1)
    t = (m - mean) / np.sqrt(m2 / (n - 1))
    a = (d**3).mean(1) / m2**1.5 / (6 * sqrt(n))
    return t, t * (1 + 2 * a * t + 4 / 3 * (a * t) ** 2) + a


def factor(skewness, kurtosis, n, x):
    a = abs(skewness) / (6 * sqrt(n))
    odd = a * x**3 * (1 + x * x / 24) * (16.5 / n + 121.5 * a * a)
    even = max(0, x**4 * (kurtosis / 4 / n - 44 * a * a / 3))
    return exp(min(2 * a * x**3, even + odd + x**6 / 3 / n**2))


def level(law, n, alpha, side):
    mean, sd, _, _, cgf, tilt, _ = law
    critical = stats.t.isf(alpha, n - 1)
    lam = side * stats.norm.isf(alpha) / sd / sqrt(n)
    corrected, plain = [], []
    for _ in range(3):
        x = tilt(lam, (max(2000, 4_000_000 // n), n))
        weight = np.exp(n * cgf(lam) - lam * x.sum(1))
        t, t_h = statistics(x, mean)
        corrected.append(weight * (np.minimum(side * t, side * t_h) >= critical))
        plain.append(weight * (side * t >= critical))
    w = np.concatenate(corrected) / alpha
    p = np.concatenate(plain) / alpha
    return f"{w.mean():.2f} +- {w.std() / sqrt(len(w)):.2f} (plain {p.mean():.2g})"


for name, law in LAWS.items():
    for n in SIZES:
        for alpha in LEVELS:
            f = factor(law[2], law[3], n, stats.norm.isf(alpha))
            if f < 20:
                print(f"{name}, n = {n}, {alpha:g}: factor {f:.2f};",
                      "; ".join(level(law, n, alpha, side) for side in law[6]), flush=True)
