#!/usr/bin/env python3
"""Reference values of the tests of means, from numpy and scipy by the definitions (influence values one
by one, products multiplied out, suprema over a dense grid). Run in this folder:
python3 make_means.py. Columns named log_* are natural logarithms of p."""
import math

import numpy as np
from scipy import optimize, stats

COMMAND = "# python3 tests/tables/make_means.py"


def write(name, header, rows):
    with open(name + ".csv", "w") as out:
        out.write(COMMAND + "\n" + header + "\n")
        for row in rows:
            out.write(",".join(repr(v) if isinstance(v, float) else str(v) for v in row) + "\n")


def skewed(k, n):
    i = np.arange(1, n + 1)
    return -np.log((i - 0.5) / n) * (1 + 0.2 * k * np.cos(0.3 * k * i))


def transformed(t, a):
    return ((1 + 2 * a * t) ** 3 - 1) / (6 * a) + a


def sixth_skewness(psi, extra=0.0):
    return (psi**3).sum() / (6 * ((psi**2).sum() + extra) ** 1.5)


def nearer_to_zero(t, psi, nu, extra=0.0):
    """The one nearer to 0 of T and the transformed T, or 0 between them; ln of the larger tails."""
    both = np.array([t, transformed(t, sixth_skewness(psi, extra))])
    return [np.median([*both, 0]), stats.t.logcdf(both, nu).max(), stats.t.logsf(both, nu).max()]


def skewness_rows():
    for k in range(1, 7):
        x, y = skewed(k, 20 * k), skewed(k + 2, 15 * k)
        scale, offset, error = 0.7 + 0.2 * k, 0.05 * k, 0.03 * k
        null = x.mean() + (k - 3.5) * 0.12
        v = x.var(ddof=1) / len(x)
        nu = (v + error**2) ** 2 / (v**2 / (len(x) - 1))
        psi = (x - x.mean()) / len(x)
        one = nearer_to_zero((x.mean() - null) / math.sqrt(v + error**2), psi, nu, error**2)
        w = scale**2 * y.var(ddof=1) / len(y)
        nu2 = (v + w) ** 2 / (v**2 / (len(x) - 1) + w**2 / (len(y) - 1))
        both = np.concatenate([psi, -scale * (y - y.mean()) / len(y)])
        two = nearer_to_zero((x.mean() - scale * y.mean() - offset) / math.sqrt(v + w), both, nu2)
        yield [k, null, error, scale, offset, *map(float, one), *map(float, two)]


def fractions(k, n):
    u = np.arange(1, n + 1) * (math.sqrt(5) - 1) / 2 % 1
    return u**k


def betting_rows():
    """ln p of both tails with the products multiplied out, for values in [-2, 3] or half-lines."""
    bets = [1 - 2.0**-10, 0.875, 0.6875] + [2.0**-k for k in range(1, 21)]

    def log_p(gains):
        e = np.mean([np.prod((1 + bet * gains).astype(np.longdouble)) for bet in bets])
        return min(0.0, -float(np.log(e)))

    for k in range(1, 6):
        for part in (1.0, 0.01):
            for n in (5, 20, 60, 128):
                x = -2 + 5 * part * fractions(k, n)
                for null in (0.1, 0.3, 0.45, 0.6, 0.95):
                    m = -2 + 5 * part * null
                    yield [k, n, part, m, log_p((m - x) / (3 - m)), log_p((x - m) / (m + 2))]


def fisher(x, n, y, m, start, slope):
    """ln p of "P(x) >= start + slope P(y)": Fisher's statistic, its least value by a grid refined."""
    def statistic(q):
        p = start + slope * q
        if not 0 <= p <= 1:
            return math.inf
        return -2 * (stats.binom.logcdf(x, n, p) + stats.binom.logsf(y - 1, m, q))

    grid = np.linspace(1e-9, 1 - 1e-9, 4001)
    at = int(np.argmin([statistic(q) for q in grid]))
    around = (grid[max(0, at - 1)], grid[min(4000, at + 1)])
    best = optimize.minimize_scalar(statistic, bounds=around, method="bounded",
                                    options={"xatol": 1e-13})
    return stats.chi2.logsf(min(best.fun, statistic(grid[at])), 4)


def two_valued_rows():
    cases = [(3, 40, 15, 50), (0, 30, 9, 60), (12, 30, 60, 60), (200, 10000, 260, 9000),
             (5, 2000, 31, 1500), (49, 50, 50, 50)]
    for x, n, y, m in cases:
        for start, slope in ((0.0, 1.0), (0.02, 1.0), (-0.03, 1.0), (0.0, 1.25)):
            yield [x, n, y, m, start, slope, fisher(x, n, y, m, start, slope)]


write("skewness_corrected_t",
      "k,null,error,scale,offset,one,one_lower,one_upper,two,two_lower,two_upper", skewness_rows())
write("betting_mean", "k,n,part,null,log_lower,log_upper", betting_rows())
write("two_valued", "x,n,y,m,start,slope,log_lower", two_valued_rows())
