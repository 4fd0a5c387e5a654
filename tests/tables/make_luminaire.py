"""Integrals over polygonal luminaires by quadrature over their area, to 25 digits.

E = integral of cx cy / r^2, C2 = of cx^2 cy / r^2, omega = of cy / r^2 (over the whole luminaire),
G2 = of (cx cy / r^2)^2, where cx and cy are the cosines at receiver and luminaire.
"""

import pathlib

from mpmath import mp, mpf, quad, sqrt

mp.dps = 30


def vec(*v):
    return [mpf(x) for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    return [x / sqrt(dot(v, v)) for x in v]


def over_triangle(a, b, c, f):
    """Integral of f over a triangle by Duffy's map."""
    ab, bc = sub(b, a), sub(c, b)
    area2 = sqrt(dot(cross(ab, bc), cross(ab, bc)))
    point = lambda u, v: [a[i] + u * (ab[i] + v * bc[i]) for i in range(3)]
    return area2 * quad(lambda u: u * quad(lambda v: f(point(u, v)), [0, 1]), [0, 1])


def over(polygon, f):
    return sum(over_triangle(polygon[0], polygon[i], polygon[i + 1], f)
               for i in range(1, len(polygon) - 1))


def integrals(normal, seen, whole):
    n = unit(normal)
    nl = unit(cross(sub(seen[1], seen[0]), sub(seen[2], seen[0])))
    h = abs(dot(nl, seen[0]))
    r2 = lambda p: dot(p, p)
    cx = lambda p: dot(n, p) / sqrt(r2(p))
    cy = lambda p: h / sqrt(r2(p))
    return [over(seen, lambda p: cx(p) * cy(p) / r2(p)),
            over(seen, lambda p: cx(p) ** 2 * cy(p) / r2(p)),
            over(whole, lambda p: cy(p) / r2(p)),
            over(seen, lambda p: (cx(p) * cy(p) / r2(p)) ** 2)]


def rectangle(x0, x1):
    y0, y1 = mpf("-0.6"), mpf("0.8")
    return [[x0, y0, mpf(1)], [x1, y0, mpf(1)], [x1, y1, mpf(1)], [x0, y1, mpf(1)]]


TRIANGLE = [vec(".2", "-.4", "1"), vec("1.6", ".3", "1.4"), vec("-.3", "1.2", "1.1")]
CORNELL = [vec(0, 5, 1), vec("-.866", 5, "-.5"), vec(".866", 5, "-.5")]
LEFT, RIGHT = mpf("-.8"), mpf(".9")
WHOLE = rectangle(LEFT, RIGHT)
UP = vec(0, 0, 1)

SCENES = [
    ("triangle", UP, TRIANGLE, TRIANGLE),
    ("cornell_triangle", vec(0, 1, 0), CORNELL, CORNELL),
    ("rectangle", UP, WHOLE, WHOLE),
    # Below the horizon where 0.9 x + 0.3 < 0.
    ("horizon", vec(".9", 0, ".3"), rectangle(mpf(-1) / 3, RIGHT), WHOLE),
] + [("hidden_beyond_" + t, UP, rectangle(LEFT, mpf(t)), WHOLE) for t in ("0.5", "0.05", "-0.5")]

with open(pathlib.Path(__file__).with_name("luminaire.csv"), "w") as out:
    out.write("# python3 tests/tables/make_luminaire.py\n")
    out.write("scene,irradiance,squared_cosine,solid_angle,squared_geometry\n")
    for name, normal, seen, whole in SCENES:
        out.write(",".join([name] + [mp.nstr(x, 25) for x in integrals(normal, seen, whole)]) + "\n")
