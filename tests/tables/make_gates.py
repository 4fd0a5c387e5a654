#!/usr/bin/env python3
"""Reference values for the assumption gates and for the law of two suprema, from scipy by other
formulas than those of stats/. Run from the root: /usr/bin/python3 tests/tables/make_gates.py."""
import math
import os

import numpy as np
from scipy import integrate, optimize, special, stats

COMMAND = "# /usr/bin/python3 tests/tables/make_gates.py"
FALSE_RED = 1e-4


def write(name, header, rows):
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), name + ".csv")
    with open(path, "w") as out:
        out.write(COMMAND + "\n" + header + "\n")
        for row in rows:
            out.write(",".join(str(v) if isinstance(v, int) else repr(float(v)) for v in row) + "\n")


def expectation(function, skewness):
    """Of a standardised gamma law of this skewness: x = e^s, by the trapezoidal rule in s, which
    converges fast as the integrand vanishes quickly at both ends."""
    shape = 4 / skewness**2
    s = np.linspace(-60 / min(shape, 1.0), math.log(shape + 60 * math.sqrt(shape) + 200), 400001)
    x = np.exp(s)
    density = np.exp(shape * s - x - special.gammaln(shape))
    z = (x - shape) / math.sqrt(shape)
    return float(np.trapz(function(z) * density, s))


def skewness_widening(g):
    """sqrt(n Var(g1) / 6) from the influence of one observation on g1."""
    def influence(z):
        return z**3 - 3 * z - g - 1.5 * g * (z * z - 1)
    return math.sqrt(expectation(lambda z: influence(z)**2, g) / 6)


def kurtosis_widening(excess):
    """sqrt(n Var(b2) / 24), likewise."""
    g = math.sqrt(2 * excess / 3)
    b2 = 3 + excess
    def influence(z):
        return z**4 - 4 * g * z - b2 - 2 * b2 * (z * z - 1)
    return math.sqrt(expectation(lambda z: influence(z)**2, g) / 24)


def d_agostino(n):
    """The |g1| whose transform of D'Agostino (1970) is the normal quantile: with scipy's transform
    of data, inverted by bisection."""
    target = stats.norm.isf(FALSE_RED / 2)
    def transform(g1):
        y = g1 * math.sqrt((n + 1) * (n + 3) / (6.0 * (n - 2)))
        b = 3.0 * (n**2 + 27 * n - 70) * (n + 1) * (n + 3) / ((n - 2.0) * (n + 5) * (n + 7) * (n + 9))
        w2 = -1 + math.sqrt(2 * (b - 1))
        return math.asinh(y / math.sqrt(2.0 / (w2 - 1))) / math.sqrt(0.5 * math.log(w2))
    return optimize.brentq(lambda g: transform(g) - target, 0, 50, xtol=1e-14)


def anscombe_glynn(n):
    target = stats.norm.isf(FALSE_RED)
    def transform(b2):
        mean = 3.0 * (n - 1) / (n + 1)
        variance = 24.0 * n * (n - 2) * (n - 3) / ((n + 1.0)**2 * (n + 3) * (n + 5))
        x = (b2 - mean) / math.sqrt(variance)
        root_beta1 = (6.0 * (n * n - 5 * n + 2) / ((n + 7) * (n + 9))
                      * math.sqrt(6.0 * (n + 3) * (n + 5) / (n * (n - 2) * (n - 3))))
        a = 6 + 8 / root_beta1 * (2 / root_beta1 + math.sqrt(1 + 4 / root_beta1**2))
        ratio = (1 - 2 / a) / (1 + x * math.sqrt(2 / (a - 4)))
        return (1 - 2 / (9 * a) - math.copysign(abs(ratio)**(1 / 3), ratio)) / math.sqrt(2 / (9 * a))
    return optimize.brentq(lambda b: transform(b) - target, 3, 200, xtol=1e-14) - 3


def check_against_scipy():
    """The transforms above are those that scipy makes of data."""
    data = stats.norm.rvs(size=60, random_state=1)**2
    n = len(data)
    g1 = stats.skew(data)
    y = g1 * math.sqrt((n + 1) * (n + 3) / (6.0 * (n - 2)))
    b = 3.0 * (n**2 + 27 * n - 70) * (n + 1) * (n + 3) / ((n - 2.0) * (n + 5) * (n + 7) * (n + 9))
    w2 = -1 + math.sqrt(2 * (b - 1))
    z = math.asinh(y / math.sqrt(2.0 / (w2 - 1))) / math.sqrt(0.5 * math.log(w2))
    assert abs(z - stats.skewtest(data).statistic) < 1e-10


def grubbs(n, level):
    """max |x - mean| / s: n (x - mean)^2 / ((n - 1)^2 s^2) of one observation is Beta(1/2, (n-2)/2)
    (Thompson 1935), and where two cannot exceed the value at once its tail counts n times."""
    return (n - 1) / math.sqrt(n) * math.sqrt(stats.beta.isf(level / n, 0.5, (n - 2) / 2))


def gate_rows():
    for n, x in ((20, 1.5), (50, 2.5), (100, 3.0), (150, 3.3), (400, 3.0), (400, 4.4), (3000, 3.9)):
        boundary = 3 * math.sqrt(n) * math.log(2) / x**3
        yield (n, x, boundary, d_agostino(n), skewness_widening(boundary), anscombe_glynn(n),
               kurtosis_widening(0.2), grubbs(n, 0.05), grubbs(n, FALSE_RED))


def suprema(gap, m, n):
    """ln of P(A + B >= gap), A of tail min(1, 2 exp(-2 m a^2)) and B of the same with n."""
    def tail(a, size):
        return 1.0 if a <= 0 else min(1.0, 2 * math.exp(-2 * size * a * a))
    start = math.sqrt(math.log(2) / (2 * n))  # B has no mass below
    kink = gap - math.sqrt(math.log(2) / (2 * m))  # from here on A's tail is 1
    def density(b):
        return 8 * n * b * math.exp(-2 * n * b * b)
    total = tail(gap, n)
    if start < gap:
        cuts = [start] + [c for c in (kink,) if start < c < gap] + [gap]
        for a, b in zip(cuts, cuts[1:]):
            total += integrate.quad(lambda t: density(t) * tail(gap - t, m), a, b, epsabs=0,
                                    epsrel=1e-10, limit=400)[0]
    return math.log(min(1.0, total))


def suprema_rows():
    for m, n in ((50, 50), (40, 1000), (1000, 40), (300, 200), (200, 300)):
        for scaled in (1.8, 2.5, 3.5, 6.0):
            gap = scaled * math.sqrt((m + n) / (2.0 * m * n)) * math.sqrt(0.5)
            yield m, n, gap, suprema(gap, m, n)


check_against_scipy()
write("gates", "n,x,boundary,skewness_quantile,skewness_widening,kurtosis_quantile,"
      "kurtosis_widening,grubbs_05,grubbs_0001", gate_rows())
write("suprema", "m,n,gap,log_p", suprema_rows())
