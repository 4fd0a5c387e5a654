#!/usr/bin/env python3
"""Student's and Welch's t in 50 digits on NIST's StRD data sets NumAcc1 to NumAcc4, whose means are
many standard errors from zero. The data are the doubles nearest to the published decimals. Run in
this folder: python3 make_numacc.py"""
from mpmath import betainc, log, mp, mpf, sqrt

mp.dps = 50


def alternating(first, low, high):
    return [first] + [low, high] * 500


SETS = {1: [10000001.0, 10000003.0, 10000002.0],
        2: alternating(1.2, 1.1, 1.3),
        3: alternating(1000000.2, 1000000.1, 1000000.3),
        4: alternating(10000000.2, 10000000.1, 10000000.3)}


def moments(values):
    exact = [mpf(v) for v in values]
    mean = sum(exact) / len(exact)
    return mean, sum((v - mean) ** 2 for v in exact) / (len(exact) - 1) / len(exact), len(exact)


def log_tails(t, nu):
    outside = betainc(nu / 2, mpf(1) / 2, 0, nu / (nu + t * t), regularized=True) / 2
    lower, upper = (outside, 1 - outside) if t < 0 else (1 - outside, outside)
    return log(lower), log(upper)


def row(k, other, scale, offset):
    mean, v, n = moments(SETS[k])
    difference, total, inverse = mean - mpf(offset), v, v * v / (n - 1)
    if other:
        mean_y, v_y, m = moments(SETS[other])
        v_y *= mpf(scale) ** 2
        difference -= mpf(scale) * mean_y
        total, inverse = v + v_y, inverse + v_y * v_y / (m - 1)
    t, nu = difference / sqrt(total), total * total / inverse
    numbers = [mp.nstr(x, 25) for x in (t, nu, *log_tails(t, nu))]
    return ",".join([str(k), str(other), repr(scale), repr(offset)] + numbers)


with open("numacc.csv", "w") as out:
    out.write("# python3 tests/tables/make_numacc.py\n")
    out.write("set,other,scale,offset,t,nu,log_lower,log_upper\n")
    for k, nulls in {1: [10000001.0, 10000002.5], 2: [1.19, 1.2003], 3: [1000000.19, 1000000.2003],
                     4: [10000000.19, 10000000.2003]}.items():
        for null in nulls:
            out.write(row(k, 0, 1.0, null) + "\n")
    for k, other, scale, offset in [(4, 3, 10.0, -1.81), (4, 3, 1.0, 8999999.9998), (3, 4, 0.1, 0.1801),
                                    (2, 3, 0.3, -300000.0), (1, 4, 1.0, 2.0)]:
        difference_row = row(k, other, scale, offset)
        out.write(difference_row + "\n")
