#!/usr/bin/python3
"""Virtual lights in a unit cube of albedo 1/2, and ratios of two means, by quadrature.

Walls are integrated over by tensor Gauss-Legendre rules in pieces that halve towards the edges and the
point that is nearest to the receiver. The receiver looks up from the floor. All walls emit 1 (even), or the
ceiling alone does.
"""
import numpy as np
from scipy import integrate

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


def pieces(breaks):
    """Nodes and weights on [0, 1] in pieces between breaks."""
    ends = sorted({0.0, 1.0, *(b for b in breaks if 0 < b < 1)})
    x = [a + (b - a) * (NODES + 1) / 2 for a, b in zip(ends, ends[1:])]
    w = [(b - a) / 2 * WEIGHTS for a, b in zip(ends, ends[1:])]
    return np.concatenate(x), np.concatenate(w)


def towards(place):
    return [place] + [p + s * 2.0**-k for p in (0, place, 1) for k in range(24) for s in (-1, 1)]


class Wall:
    """Points of the wall where coordinate `axis` is `side`, seen from a point of the floor."""

    def __init__(self, axis, side, receiver):
        u, wu = pieces(towards(receiver[0 if axis != 0 else 1]))
        v, wv = pieces(towards(receiver[1] if axis == 2 else 0.0))
        u, v = np.meshgrid(u, v, indexing="ij")
        at = {0: (side + 0 * u, u, v), 1: (u, side + 0 * u, v), 2: (u, v, side + 0 * u)}[axis]
        self.x, self.y, self.z = at
        self.weights = np.outer(wu, wv)
        self.axis = axis
        way = (at[0] - receiver[0], at[1] - receiver[1], at[2])
        self.square = way[0] ** 2 + way[1] ** 2 + way[2] ** 2
        # cos cos' / (pi r^2)
        self.kernel = way[2] * np.abs(way[axis]) / (np.pi * self.square**2)

    def integral(self, f):
        return float(np.sum(self.weights * f))


def walls(receiver):
    return [Wall(0, 0, receiver), Wall(0, 1, receiver), Wall(1, 0, receiver), Wall(1, 1, receiver),
            Wall(2, 1, receiver)]


def ceiling_from(wall):
    """The form factor from points of an upright wall to the ceiling: Lambert's formula of a rectangle at
    right angles, its near edge at the distance c above."""
    along = wall.y if wall.axis == 0 else wall.x
    c = 1 - wall.z
    far = np.sqrt(c * c + 1)

    def half(b):
        return np.arctan2(b, c) - c / far * np.arctan2(b, far)

    return (half(along) + half(1 - along)) / (2 * np.pi)


def no_cosine_from(wall):
    """The integral of cos1 / r^2 over all other walls, cos1 being the cosine at the wall alone."""
    p, q = (wall.y if wall.axis == 0 else wall.x), wall.z
    if wall.axis == 2:
        p, q = wall.x, wall.y

    def asinh_difference(low, high, distance):
        return np.arcsinh(high / distance) - np.arcsinh(low / distance)

    total = 0
    # The four walls at right angles, each at the distance d, from the depth 0 to 1.
    for d, low, high in ((p, -q, 1 - q), (1 - p, -q, 1 - q), (q, -p, 1 - p), (1 - q, -p, 1 - p)):
        total = total + asinh_difference(low, high, d) - asinh_difference(low, high,
                                                                          np.sqrt(1 + d * d))
    for x in (p, 1 - p):  # the solid angle of the wall opposite
        for y in (q, 1 - q):
            total = total + np.arctan(x * y / np.sqrt(1 + x * x + y * y))
    return total


def other_paths(all_walls, count):
    """E[S] E[1 / S'] - 1 for sums of `count` of X = 6 pi kernel / pi at uniform points, by the Laplace
    transform phi of X: E[1 / S; S > 0] is the integral of phi^count less its limit."""
    x = np.concatenate([6 * wall.kernel.ravel() for wall in all_walls])
    w = np.concatenate([wall.weights.ravel() / 6 for wall in all_walls])
    nothing = 1 / 6  # the floor sees nothing of itself

    def excess(t):
        return (nothing + float(np.sum(w * np.exp(-t * x)))) ** count - nothing**count

    inverse = sum(integrate.quad(excess, a, b, epsabs=1e-12)[0]
                  for a, b in ((0, 0.1), (0.1, 1), (1, 10), (10, 100)))
    return count * inverse - 1


def unhidden(file, receiver):
    """The form factors, hidden or not, from a point of the floor of a room to the faces of an OBJ file
    that face it."""
    vertices, total = [], 0.0
    for line in open(file):
        word, *rest = line.split() or ["#"]
        if word == "v":
            vertices.append(np.array([float(r) for r in rest]))
        if word != "f":
            continue
        corners = [vertices[int(r.split("/")[0]) - 1] - receiver for r in rest]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        if np.dot(normal, corners[0]) > -1e-12:  # faces are counter-clockwise from inside
            continue
        edges = zip(corners, corners[1:] + corners[:1])
        total += abs(sum(np.arccos(np.dot(a, b) / np.linalg.norm(a) / np.linalg.norm(b))
                         * np.cross(a, b)[2] / np.linalg.norm(np.cross(a, b))
                         for a, b in edges if np.linalg.norm(np.cross(a, b)) > 0)) / (2 * np.pi)
    return total


def ratio():
    """exp(3 x) beside 5 (1 + x)^4 / 31 on [0, 1]."""
    def mean(f):
        return integrate.quad(f, 0, 1, epsabs=1e-12, epsrel=1e-12)[0]

    def f(x):
        return np.exp(3 * x)

    def g(x):
        return 5 * (1 + x) ** 4 / 31

    whole = mean(f)
    variance = mean(lambda x: g(x) ** 2) - 1
    covariance = mean(lambda x: f(x) * g(x)) - whole
    return {"ratio_integral": whole, "ratio_variance": whole * variance,
            "ratio_covariance": covariance, "mean_of_ratios": mean(lambda x: f(x) / g(x))}


middle = walls((0.5, 0.5))
corner = walls((0.005, 0.005))
upright = middle[:4]
seen = sum(w.integral(ceiling_from(w) * w.kernel) for w in upright)
lit = sum(w.integral(ceiling_from(w)) for w in upright)
lit_square = sum(w.integral(ceiling_from(w) ** 2) for w in upright)
ceiling = middle[4].integral(middle[4].kernel)
table = {
    "all_walls": sum(w.integral(w.kernel) for w in middle),
    "all_walls_from_corner": sum(w.integral(w.kernel) for w in corner),
    "ceiling": ceiling,
    "radiance_from_ceiling": seen / 4,
    "mean_of_weights": (1 - ceiling) / 4 * lit_square / lit,
    "density_of_direction_target": sum(w.integral(w.kernel * no_cosine_from(w)) for w in middle) / 6,
    "other_paths_16": other_paths(middle, 16),
    "other_paths_8": other_paths(middle, 8),
}
for least in (0.1, 0.3):
    table["clamped_%g_in_corner" % least] = sum(
        w.integral(w.kernel * np.minimum(1, w.square / least**2)) for w in corner)
table["unhidden_in_corridor"] = unhidden("suites/data/room.obj", np.array([1.6, 0.5, 0]))
table.update(ratio())
if __name__ == "__main__":
    print("# /usr/bin/python3 tests/tables/make_virtual_lights.py > tests/tables/virtual_lights.csv")
    print("what,value")
    for name, value in table.items():
        print("%s,%.12g" % (name, value))
