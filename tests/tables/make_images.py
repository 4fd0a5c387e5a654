#!/usr/bin/python3
"""Reference values for tests/stats/image_*_test.cpp, by numpy and scipy: make_images.py TABLE

TABLE is t_to_z or image_equivalence. Jackknives leave replicates out and start again.
"""
import math
import sys

import numpy as np
from scipy import stats

WIDTH, HEIGHT, CHANNELS = 13, 9, 2


def images(k, replicates):
    """Replicates of image k in single precision, as images_of in tests/stats/images/image_tables_test.cpp."""
    e = np.arange(WIDTH * HEIGHT * CHANNELS)
    stack = []
    for r in range(replicates):
        wave = np.sin(1 + 0.37 * e + 1.7 * r * r + 0.9 * k * e)
        tooth = 1 + (7 * r + 3 * e + k) % 5 / 4
        stack.append(wave * tooth + 0.4 + 0.05 * k + 0.01 * (e % 11))
    return np.array(stack, dtype=np.float32).astype(float)


def show(*cells):
    print(",".join(c if isinstance(c, str) else f"{c:.17g}" for c in cells))


def t_to_z():
    show("degrees", "t", "z")
    for degrees in (7, 10, 15, 22.5, 30, 60, 126, 1000):
        for z in (0.001, 0.1, 0.5, 1, 2, 3, 4, 5, 6, 7, 8):
            show(degrees, stats.t.isf(stats.norm.sf(z), degrees), z)


A, B = images(1, 16), images(2, 19)


def jackknife(a, b, functional):
    whole = functional(a, b)
    variance = 0.0
    for n, values in ((len(a), [functional(np.delete(a, r, 0), b) for r in range(len(a))]),
                      (len(b), [functional(a, np.delete(b, r, 0)) for r in range(len(b))])):
        variance += (n - 1) / n * ((values - np.mean(values)) ** 2).sum()
    return whole, math.sqrt(variance), min(len(a), len(b)) - 1


def image_equivalence():
    def error(x):
        return x.var(axis=0, ddof=1) / len(x)

    def bias(a, b):
        return (a.mean(axis=0) - b.mean(axis=0)) ** 2 - error(a) - error(b)

    show("what", "estimate", "standard_error", "lower_p")
    plain = jackknife(A, B, lambda a, b: bias(a, b).sum())
    show("squared", plain[0], plain[1], 0.0)
    for margin in (0.5, 1.0):
        u, se, nu = jackknife(
            A, B, lambda a, b: (bias(a, b) - margin ** 2 * (b.mean(axis=0) ** 2 - error(b))).sum())
        show(f"margin {margin}", u, se, stats.t.cdf(u / se, nu))


TABLES = {f.__name__: f for f in (t_to_z, image_equivalence)}
print(f"# tests/tables/make_images.py {sys.argv[1]} > tests/tables/{sys.argv[1]}.csv "
      f"(numpy {np.__version__}, scipy {__import__('scipy').__version__})")
TABLES[sys.argv[1]]()
