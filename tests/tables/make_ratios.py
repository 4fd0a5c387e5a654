#!/usr/bin/env python3
"""Reference values for efficiencies, slopes, quantiles and laws of distances, from numpy, scipy and
mpmath by other formulas than those of stats/. Run in this folder: /usr/bin/python3 make_ratios.py."""
import math

import numpy as np
from scipy import optimize, stats

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


def efficiency(x, c, reference=None, u=0.0):
    """ln efficiency and its standard error from the influence of every observation."""
    n = len(x)
    if reference is None:
        square = (x - x.mean()) ** 2
        error = np.var(x, ddof=1)
        psi = square / square.mean() + c / c.mean() - 2
        # the n - 1 convention of Var(s2) and of Var(cost), written out term by term
        joint = np.cov(square / square.mean(), c / c.mean(), ddof=0)[0, 1]
        spread = (stats.kurtosis(x, fisher=False) - (n - 3) / (n - 1)
                  + np.var(c, ddof=1) / c.mean() ** 2 + 2 * joint)
        assert abs(spread - np.mean(psi**2)) < 8 / n
        return -math.log(error * c.mean()), math.sqrt(spread / n)
    square = (x - reference) ** 2
    error = square.mean() - u * u
    spread = (np.var(square, ddof=1) / error**2 + np.var(c, ddof=1) / c.mean() ** 2
              + 2 * np.cov(square, c, ddof=0)[0, 1] / error / c.mean())
    slope = 2 * (x.mean() - reference) / error
    return -math.log(error * c.mean()), math.hypot(math.sqrt(spread / n), slope * u)


def efficiency_rows():
    for k in (1, 2, 3):
        n = 40 * k
        x, c = sample(k, n), costs(k, n)
        value, se = efficiency(x, c)
        biased, biased_se = efficiency(x, c, 0.1 * k, 0.05)
        y, d = sample(k + 3, n), costs(k + 3, n)
        other, other_se = efficiency(y, d)
        z = (value - other - math.log(1.5)) / math.hypot(se, other_se)
        cost_z = ((math.log(c.mean() / d.mean()) - math.log(1.1))
                  / math.hypot(stats.sem(c) / c.mean(), stats.sem(d) / d.mean()))
        yield [k, n, value, se, biased, biased_se, z, stats.norm.sf(z), cost_z]


if __name__ == "__main__":
    write("log_efficiency", "k,n,value,error,biased,biased_error,ratio_z,ratio_upper,cost_z",
          efficiency_rows())
