#!/usr/bin/python3
"""A row of pixels across the wave of `sinusoid`, interpolated between every so many of them: prints
tests/tables/reconstruction.csv.

The lens leaves 1/2 + 1/2 j(3) cos(30 x) of the wave. Beyond the last sample a pixel is that sample.
"""
import numpy as np
from scipy import special


def row(width, size, spacing):
    x = (np.arange(width) + .5 - width / 2) * size / width
    mean = .5 + special.j1(3) / 3 * np.cos(30 * x)
    off = np.interp(x, x[::spacing], mean[::spacing]) - mean
    worst = np.argmax(abs(off))
    return [np.sqrt(np.mean(off ** 2) / np.mean(mean ** 2)), worst, mean[worst],
            mean[worst] + off[worst]]


print("# /usr/bin/python3 tests/tables/make_reconstruction.py > tests/tables/reconstruction.csv")
print("width,size,spacing,relative_rms,worst,mean,reconstructed")
for width, size, spacing in ((57, .42, 8), (57, 1, 4), (57, 1, 8), (64, 1, 4)):
    rms, worst, mean, value = row(width, size, spacing)
    print(f"{width},{size},{spacing},{rms:.12g},{worst},{mean:.12g},{value:.12g}")
