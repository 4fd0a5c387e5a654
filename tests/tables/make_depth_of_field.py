#!/usr/bin/python3
"""Lens averages of pixels and Fourier identities: prints tests/tables/depth_of_field.csv.

Moments are integrals over the lens by scipy, the picture evaluated point by point in strips between
edges; lens variances of random textures are by discrete Fourier transform.
"""
import numpy as np
from scipy import integrate, special


def moments(scene, pixel):
    """First two moments over the disc by nested adaptive quadrature, edges given as break points."""
    radius, focus, background, planes = scene

    def radiance(u, v):
        for depth, x, y, (m, a, k, p) in sorted(planes):
            s, g = (1 - depth / focus) * radius, depth / focus
            px, py = s * u + g * pixel[0], s * v + g * pixel[1]
            if x[0] <= px <= x[1] and y[0] <= py <= y[1]:
                return m + a * np.cos(k * px + p)
        return background

    def edges(axis):
        out = []
        for plane in planes:
            depth, side = plane[0], plane[1 + axis]
            s, g = (1 - depth / focus) * radius, depth / focus
            if s != 0:
                out += [(e - g * pixel[axis]) / s for e in side]
        return [e for e in out if abs(e) < 1]

    def pieces(f, low, high, breaks):
        ends = [low] + sorted(b for b in breaks if low < b < high) + [high]
        return sum(integrate.quad(f, a, b, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
                   for a, b in zip(ends, ends[1:]))

    def column(v, power):
        half = np.sqrt(1 - v * v)
        return pieces(lambda u: radiance(u, v) ** power, -half, half, edges(0))

    circle = [s * np.sqrt(1 - e * e) for e in edges(0) for s in (-1, 1)]
    return [pieces(lambda t: column(np.sin(t), n) * np.cos(t) / np.pi, -np.pi / 2, np.pi / 2,
                   [np.arcsin(e) for e in edges(1) + circle]) for n in (1, 2)]


far = (-100, 100)
edge = (.2, 2, 0, [(1, (0, 100), far, (0, 0, 0, 0)), (2, far, far, (1, 0, 0, 0))])
wave = (.2, 2, 0, [(4, far, far, (.5, .5, 15, 0))])
corner = (.2, 2, .3, [(1, (0, 100), (-100, .02), (0, 0, 0, 0)),
                      (3, (-.1, .05), (-.1, 100), (.5, .5, 2 * np.pi / .1, .4))])
print("# /usr/bin/python3 tests/tables/make_depth_of_field.py > tests/tables/depth_of_field.csv")
print("what,x,y,mean,square")
for name, scene, pixels in (("edge", edge, [(0, 0), (-.1, 0), (.14, .3)]),
                            ("sinusoid", wave, [(0, 0), (.05, 0), (.13, 0)]),
                            ("corner", corner, [(0, 0), (.05, .01), (-.12, -.05)])):
    for pixel in pixels:
        m, s = moments(scene, pixel)
        print(f"{name},{pixel[0]},{pixel[1]},{m:.15g},{s:.15g}")

# The variance of a wave over the lens, averaged over its phase: quadratures summed over a grid of
# phases. Parseval says that it is half the squared amplitude times 1 - j^2.
for depth, k in ((1, 12), (3, 20), (7, 9)):
    radius, focus = .2, 2
    reach = k * (1 - depth / focus) * radius
    total = 0
    for phase in np.arange(16) * np.pi / 8:
        def part(power):
            f = lambda t: np.cos(reach * np.sin(t) + phase) ** power * np.cos(t) ** 2 * 2 / np.pi
            return integrate.quad(f, -np.pi / 2, np.pi / 2, epsabs=1e-13, limit=400)[0]
        total += (part(2) - part(1) ** 2) / 16
    print(f"parseval,{depth},{k},{total:.15g},0")
