#!/usr/bin/python3
"""Reference values for tests/stats/image_*_test.cpp, by numpy and scipy: make_images.py TABLE

TABLE is t_to_z, image_welch, image_stack, image_flip or image_equivalence. Windows are cut
out and summed one by one, jackknives leave replicates out and start again, flips flip every image.
"""
import math
import sys

import numpy as np
from scipy import stats

WIDTH, HEIGHT, CHANNELS = 13, 9, 2


def images(k, replicates):
    """Replicates of image k, as images_of in tests/stats/image_tables_test.cpp."""
    e = np.arange(WIDTH * HEIGHT * CHANNELS)
    stack = []
    for r in range(replicates):
        wave = np.sin(1 + 0.37 * e + 1.7 * r * r + 0.9 * k * e)
        tooth = 1 + (7 * r + 3 * e + k) % 5 / 4
        stack.append(wave * tooth + 0.4 + 0.05 * k + 0.01 * (e % 11))
    return np.array(stack)


def planes(values):
    return values.reshape(*values.shape[:-1], HEIGHT, WIDTH, CHANNELS)


def show(*cells):
    print(",".join(c if isinstance(c, str) else f"{c:.17g}" for c in cells))


def t_to_z():
    show("degrees", "t", "z")
    for degrees in (7, 10, 15, 22.5, 30, 60, 126, 1000):
        for z in (0.001, 0.1, 0.5, 1, 2, 3, 4, 5, 6, 7, 8):
            show(degrees, stats.t.isf(stats.norm.sf(z), degrees), z)


A, B = images(1, 16), images(2, 19)
REFERENCE = 0.45 + 0.01 * (np.arange(A.shape[1]) % 11)
ERROR = 0.02 * (np.arange(A.shape[1]) % 3)


def image_welch():
    show("element", "t", "p", "one_t", "one_p")
    two = stats.ttest_ind(A, B, axis=0, equal_var=False)
    one = stats.ttest_1samp(A, REFERENCE, axis=0)
    for e in range(A.shape[1]):
        show(e, two.statistic[e], two.pvalue[e], one.statistic[e], one.pvalue[e])


def windows():
    """(size, grid, share, [(x, y, width, height)]) of every group."""
    longest = max(WIDTH, HEIGHT)
    sizes = [s for s in (1, 2, 4, 8, 16, 32) if s < longest] + [longest]
    share = (1 - 0.15 - 0.025) / (len(sizes) + 1)
    groups = []
    for size in sizes:
        aligned, shifted = [], []
        step = max(1, size // 4)
        for y in range(HEIGHT):
            for x in range(WIDTH):
                w, h = min(size, WIDTH - x), min(size, HEIGHT - y)
                whole_w, whole_h = min(size, WIDTH), min(size, HEIGHT)
                if x % size == 0 and y % size == 0:
                    aligned.append((x, y, w, h))
                elif x % step == 0 and y % step == 0 and w == whole_w and h == whole_h:
                    shifted.append((x, y, w, h))
        level = share * (2 if size == longest else 1)
        parts = [("aligned", aligned)] + ([("shifted", shifted)] if shifted else [])
        groups += [(size, grid, level / len(parts), list_) for grid, list_ in parts]
    return groups + [(longest, "alternating", 0.025, [0, 1, 2])]


Y, X = np.mgrid[0:HEIGHT, 0:WIDTH]
SIGNS = [(-1.0) ** X, (-1.0) ** Y, (-1.0) ** (X + Y)]


def cut(plane, grid, window):
    """The values of a window of a plane (the last two axes)."""
    if grid == "alternating":
        return (plane * SIGNS[window]).reshape(*plane.shape[:-2], -1)
    x, y, w, h = window
    return plane[..., y:y + h, x:x + w].reshape(*plane.shape[:-2], -1)


def adjusted(p, count, share):
    return min(0.0, math.log(-math.expm1(count * math.log1p(-p)) / share)) if p < 1 else 0.0


def smooth(v):
    """3 x 3 means, first along rows, then along columns."""
    def line(values):
        return np.array([values[max(i - 1, 0):i + 2].mean(axis=0) for i in range(len(values))])
    return line(np.swapaxes(line(np.swapaxes(v, 0, 1)), 0, 1))


def stack_rows(b):
    a = planes(A + 0.8)
    d, v, w = [], [], []
    for h in (0, 1):
        difference = a[h::2].mean(axis=0)
        variance = a[h::2].var(axis=0, ddof=1) / len(a[h::2])
        own = variance  # a reference's error joins no weight
        if b is None:
            difference = difference - planes(REFERENCE)
            variance = variance + planes(ERROR) ** 2
        else:
            difference = difference - b[h::2].mean(axis=0)
            variance = own = variance + b[h::2].var(axis=0, ddof=1) / len(b[h::2])
        d.append(difference)
        v.append(variance)
        w.append(1 / np.sqrt((own + smooth(own)) / 2))
    name = "reference" if b is None else "stack"
    for size, grid, share, list_ in windows()[1:]:
        found = []
        for c in range(CHANNELS):
            for window in list_:
                effect, variance, reciprocal = 0.0, 0.0, 0.0
                for h in (0, 1):
                    for sign, stack in ((1, a), (-1, b)):
                        if stack is None:
                            continue
                        part = stack[h::2, ..., c]
                        if b is None:
                            part = part - planes(REFERENCE)[..., c]
                        sums = cut(w[1 - h][..., c] * part, grid, window).sum(axis=-1)
                        share_of = sums.var(ddof=1) / len(sums) / 4
                        effect += sign * sums.mean() / 2
                        variance += share_of
                        reciprocal += share_of ** 2 / (len(sums) - 1)
                if b is None:
                    mean_w = (w[0] + w[1])[..., c] / 2
                    error = cut((mean_w * planes(ERROR)[..., c]) ** 2,
                                "aligned" if grid != "alternating" else grid,
                                window if grid != "alternating" else 0)
                    variance += abs(error).sum()
                found.append((effect / math.sqrt(variance), variance ** 2 / reciprocal, c))
        p = [2 * stats.t.sf(abs(t), nu) for t, nu, _ in found]
        best = p.index(min(p))
        show(name, size, grid, found[best][0], found[best][2], p[best],
             adjusted(p[best], len(found), share))
    error = 0 if b is not None else planes(ERROR) ** 2
    u = (w[1] ** 2 * (d[0] ** 2 - v[0]) + w[0] ** 2 * (d[1] ** 2 - v[1])
         + 2 * w[0] * w[1] * (d[0] * d[1] - error))
    t = [u[..., c].sum() / math.sqrt((u[..., c] ** 2).sum()) for c in range(CHANNELS)]
    p = stats.norm.sf(max(t))
    show(name, max(WIDTH, HEIGHT), "energy", max(t), t.index(max(t)), p,
         min(0.0, math.log(p * CHANNELS / 0.15)))


def image_stack():
    show("second", "size", "grid", "t", "channel", "p", "adjusted")
    stack_rows(planes(B))
    stack_rows(None)


def image_flip():
    """Every sign vector; b has as many replicates as a, and `shift` is added to a."""
    show("shift", "statistic", "p")
    for shift in (0.0, 0.15, 0.3):
        d = A + shift - images(2, 16)
        divisor = (d * d).sum(axis=0)
        reached, observed = 0, None
        for bits in range(2 ** 15):
            signs = np.array([1] + [1 - 2 * (bits >> k & 1) for k in range(15)])
            q = ((signs @ d) ** 2 / divisor).sum()
            observed = q if observed is None else observed
            reached += q >= observed * (1 - 1e-12)
        show(shift, observed, reached / 2 ** 15)


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


TABLES = {f.__name__: f for f in (t_to_z, image_welch, image_stack, image_flip,
                                  image_equivalence)}
print(f"# tests/tables/make_images.py {sys.argv[1]} > tests/tables/{sys.argv[1]}.csv "
      f"(numpy {np.__version__}, scipy {__import__('scipy').__version__})")
TABLES[sys.argv[1]]()
