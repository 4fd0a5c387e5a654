"""The same as tails_bench.cpp by scipy.special's ufuncs, which give one tail: /usr/bin/python3."""

import time

import numpy
from scipy import special

COUNT = 1_000_000
REPETITIONS = 7


def spread(irrational):
    return numpy.mod(numpy.arange(1, COUNT + 1) * irrational, 1)


def report(name, function, *arguments):
    times = []
    for _ in range(REPETITIONS):
        start = time.process_time()
        tails = function(*arguments)
        times.append(time.process_time() - start)
    times.sort()
    with numpy.errstate(divide="ignore"):
        total = numpy.sum(numpy.log(tails))
    print(f"{name:<12} {1e9 * times[len(times) // 2] / COUNT:7.1f} ns a p-value, median; "
          f"{1e9 * times[0] / COUNT:7.1f} best; sum of ln p {total:.9g} (scipy)")


golden = spread(0.6180339887498949)
degrees = 5 * 400.0 ** spread(0.41421356237309503)
report("t", special.stdtr, degrees, -(10 * golden - 5))
report("chi-square", special.chdtrc, degrees, degrees * (0.5 + 1.5 * golden))
report("F", special.fdtrc, degrees, degrees[::-1].copy(), 0.5 + 1.5 * golden)
