#!/usr/bin/env python3
"""Reference values for efficiencies, slopes, quantiles and laws of distances, from numpy and scipy
by other formulas than those of stats/. Run in this folder: /usr/bin/python3 make_ratios.py."""
import math

import numpy as np
from scipy import integrate, optimize, stats

COMMAND = "# /usr/bin/python3 tests/tables/make_ratios.py"


def write(name, header, rows):
    with open(name + ".csv", "w") as out:
        out.write(COMMAND + "\n" + header + "\n")
        for row in rows:
            out.write(",".join(str(v) if isinstance(v, (int, str)) else repr(float(v))
                               for v in row) + "\n")


def sample(k, size):
    """The data sets of make_tables.py."""
    i = np.arange(1, size + 1)
    tooth = 1 + np.fmod(0.05 * k * i, 3)
    return np.cos(i * (0.7 + 0.1 * k)) * tooth + 0.01 * k * i + 0.3 * k


def costs(k, size):
    i = np.arange(1, size + 1)
    return 2 + np.fmod(0.37 * k * i, 1.5) + 0.2 * np.abs(sample(k, size))


def influence(x, c=None, truth=None):
    """ln of the variance or error (times the mean cost), and every observation's influence over it."""
    square = (x - (x.mean() if truth is None else truth)) ** 2
    value = np.var(x, ddof=1) if truth is None else square.mean()
    psi = square / square.mean()
    second = 2 / len(x) / (len(x) - 1) if truth is None else 0  # of the variance of s2
    if c is None:
        return math.log(value), psi, second
    return math.log(value * c.mean()), psi + c / c.mean() - 1, second


def hall(parts, difference):
    """Of Student's t of sum w mean(psi) and of its correction by Hall: the one nearer to 0, or 0 between
    them, and the larger upper p. `parts`: w, psi, second."""
    variance = [w**2 * (np.var(psi, ddof=1) / len(psi) + second) for w, psi, second in parts]
    t = difference / math.sqrt(sum(variance))
    degrees = sum(variance) ** 2 / sum(v**2 / (len(p[1]) - 1) for v, p in zip(variance, parts))
    third = sum(w**3 * np.sum((psi - psi.mean()) ** 3) / len(psi) ** 3 for w, psi, _ in parts)
    plain = sum(w**2 * (np.var(psi) / len(psi) + second * (len(psi) - 1) / len(psi))
                for w, psi, second in parts)
    a = third / plain**1.5 / 6
    corrected = ((1 + 2 * a * t) ** 3 - 1) / (6 * a) + a
    return np.median([t, corrected, 0]), stats.t.sf(min(t, corrected), degrees)


def of_one(x, distance):
    return hall([(1, *x[1:])], 1 - math.exp(distance))


def of_two(x, y, distance):
    """The null is at this distance from the estimate."""
    r = math.exp(distance)
    return hall([(1, *x[1:]), (-r, *y[1:])], 1 - r)


def influence_rows():
    for k in (1, 2, 3):
        n = 40 * k
        x, c = sample(k, n), costs(k, n)
        y, d = sample(k + 3, n), costs(k + 3, n)
        cost = lambda v: (math.log(v.mean()), v / v.mean(), 0)
        tests = [of_one(influence(x), -0.3),
                 of_two(influence(x), influence(y), -0.2),
                 of_one(influence(x, c), 0.2),
                 of_one(influence(x, c, 0.1 * k), -0.25),
                 of_two(influence(x, c), influence(y, d, 0.1), 0.1),
                 of_two(cost(c), cost(d), -0.03)]
        yield [k, n, influence(x)[0], influence(x, c)[0], influence(x, c, 0.1 * k)[0],
               *[number for test in tests for number in test]]


SLOPES = [  # sizes, biases, standard errors, error of the reference, slope held against them
    ([8, 16, 32, 64], [.1281, .0613, .0322, .0157], [.004, .004, .004, .004], .002, -1.0),
    ([8, 16, 32, 64], [-.125, -.066, -.028, -.012], [.01, .008, .006, .005], .003, -0.8),
    ([8, 16, 32, 64], [.125, .066, .028, .012], [.05, .05, .05, .05], .01, -1.2),
    ([8, 16, 32, 64], [.125, .01, .0, .01], [.01, .01, .01, .01], .0, -1.2),
    ([1, 10, 100], [1.0, 3.1, 10.2], [.02, .05, .2], .1, 0.45),
    ([1, 2, 4, 8, 16], [1, -1, 1, -1, 1], [.1, .1, .1, .1, .1], .0, 0.0),
]


def misfit(case, s, logs=False):
    """Generalised least squares with the full covariance matrix, inverted."""
    size, b, se, u, _ = [np.array(v, dtype=float) for v in case]
    covariance = np.diag(se**2) + u**2
    precision = np.linalg.inv(covariance)
    b = b - s * np.log(size) if logs else b
    shape = np.ones_like(size) if logs else np.exp(s * (np.log(size) - np.log(size[-1 if s > 0 else 0])))
    c = shape @ precision @ b / (shape @ precision @ shape)
    r = b - c * shape
    return r @ precision @ r


def slope_ends(case, confidence, logs=False):
    degrees = len(case[0]) - 1
    level = stats.chi2.ppf(confidence, degrees)
    grid = np.linspace(-60, 60, 24001)
    inside = np.array([misfit(case, s, logs) <= level for s in grid])
    if not inside.any():
        return math.nan, math.nan
    first, last = np.flatnonzero(inside)[[0, -1]]
    f = lambda s: misfit(case, s, logs) - level
    low = -math.inf if first == 0 else optimize.brentq(f, grid[first - 1], grid[first], xtol=1e-14)
    high = (math.inf if last == len(grid) - 1
            else optimize.brentq(f, grid[last], grid[last + 1], xtol=1e-14))
    return low, high


def slope_rows():
    for index, case in enumerate(SLOPES):
        for logs in (0, 1):
            if logs and min(case[1]) <= 0:
                continue
            used = case
            if logs:
                b, se = np.array(case[1]), np.array(case[2])
                used = (case[0], np.log(b), se / b, 0, case[4])
            q = misfit(used, case[4], logs)
            p = stats.chi2.sf(q, len(case[0]) - 1)
            low, high = slope_ends(used, 0.99, logs)
            power = stats.ncx2.sf(stats.chi2.ppf(0.99, len(case[0]) - 1), len(case[0]) - 1, q)
            yield [index, logs, case[4], q, p, low, high, power]


def quantile_rows():
    """Order statistics and binomial tails by enumeration, comparisons over every split."""
    for k, n, m, q in ((1, 60, 45, 0.5), (2, 200, 150, 0.9), (3, 400, 400, 0.25), (1, 12, 9, 0.99)):
        x, y = np.sort(sample(k, n)), np.sort(sample(k + 3, m))
        v = 0.3 * k + 0.5
        lower = stats.binom.sf(np.sum(x < v) - 1, n, q)
        upper = stats.binom.cdf(np.sum(x <= v), n, q)
        ranks = np.arange(n + 1)
        kept = ranks[stats.binom.cdf(ranks, n, q) > 0.005]
        low = -math.inf if kept[0] == 0 else x[kept[0] - 1]
        kept = ranks[stats.binom.sf(ranks - 1, n, q) > 0.005]
        high = math.inf if kept[-1] == n else x[kept[-1]]
        d = 0.1 * k
        combined = []
        for a, b in ((x, y + d), (y + d, x)):
            product = max(stats.binom.sf(np.sum(a < v) - 1, len(a), q)
                          * stats.binom.cdf(np.sum(b <= v), len(b), q)
                          for v in np.concatenate([a, b]))
            combined.append(product * (1 - math.log(product)))
        yield [k, n, m, q, lower, upper, low, high, *combined]


def ledger_rows():
    """Laws of the pooled difference by quadrature over theta and the reference's error."""
    for k, count, u in ((1, 48, 0.0), (1, 50, 0.1), (2, 60, 0.2)):
        i = np.arange(1, count + 1)
        y = 0.5 * np.cos(1.3 * i * k) + np.where(i > 14, 0.2 * k, 0.0)
        e = 0.5 + 0.1 * (i % 3)
        n = 100.0 + 50 * (i % 2)

        def pooled(part):
            weight = n[part].sum()
            return (n * y)[part].sum() / weight, (n**2 * e**2)[part].sum() / weight**2

        d, v = pooled(slice(None))
        tau = np.sqrt(0.2 * n.sum() / n[0] * v)

        def law(mean):
            if u == 0:
                return stats.norm.pdf(d, mean, np.sqrt(v))
            inner = lambda r: stats.norm.pdf(d, mean + r, np.sqrt(v)) * stats.norm.pdf(r, 0, u)
            return integrate.quad(inner, -8 * u, 8 * u, epsabs=0, epsrel=1e-12, limit=200)[0]

        mixed = integrate.quad(lambda theta: law(theta) * stats.norm.pdf(theta, 0, tau),
                               -9 * tau, 9 * tau, epsabs=0, epsrel=1e-11, limit=400)[0]

        def change(first):
            after = pooled(slice(first, None))
            if first == 0:
                laws = [stats.norm(0, np.sqrt(after[1] + u**2 + w)) for w in (0, tau**2)]
                return laws[1].logpdf(after[0]) - laws[0].logpdf(after[0])
            before = pooled(slice(first))
            base = np.diag([before[1], after[1]]) + u**2
            at = [before[0], after[0]]
            null = stats.multivariate_normal([0, 0], base).logpdf(at)
            return stats.multivariate_normal([0, 0], base + np.diag([0, tau**2])).logpdf(at) - null

        changes = np.array([change(j) for j in range(count)])
        share = np.exp(changes) / np.exp(changes).sum()
        yield [k, count, u, np.log(mixed / law(0)), int(changes.argmax()), changes.max(), share[2]]


def ledger_p_rows():
    """Mixtures of products of kappa p^(kappa - 1) by quadrature over kappa."""
    for count, total in ((1, 0.0), (1, 2.5), (3, 40.0), (10, 4.0), (55, 55.0), (55, 120.0),
                         (400, 390.0), (400, 402.0), (1000, 0.0), (1000, 1100.0), (20, 5000.0)):
        log = lambda kappa: count * np.log(kappa) + (1 - kappa) * total
        top = min(1.0, count / total) if total else 1.0
        cut = sorted({0.0, max(0.0, top - 0.05), top, min(1.0, top + 0.05), 1.0})
        parts = [integrate.quad(lambda kappa: np.exp(log(kappa) - log(top)), a, b, epsabs=0,
                                epsrel=1e-12, limit=400)[0] for a, b in zip(cut, cut[1:])]
        yield [count, total, np.log(sum(parts)) + log(top)]


if __name__ == "__main__":
    names = ("variance", "variances", "efficiency", "biased", "efficiencies", "costs")
    write("influence", "k,n,ln_variance,ln_product,ln_biased,"
          + ",".join(f"{name}_t,{name}_upper" for name in names), influence_rows())
    write("slope", "case,logs,null,misfit,p,low,high,power", slope_rows())
    write("quantile", "k,n,m,q,lower,upper,low,high,compare_lower,compare_upper", quantile_rows())
    write("ledger", "k,nights,u,log_e,night,change,share_2", ledger_rows())
    write("ledger_p", "nights,minus_log_p,log_e", ledger_p_rows())
