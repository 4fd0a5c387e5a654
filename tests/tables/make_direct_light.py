#!/usr/bin/python3
"""Direct lighting by a square, by the midpoint rule on the light.

moments: the radiance reflected and the variances of a primary of combinations of light and BRDF
sampling. mutants: what broken combinations tend to.
ceiling: the mean and the variance of a primary of BRDF sampling where all directions are lit.
"""
import sys

import numpy as np

VIEWER = (np.sin(0.8) * np.cos(3.1416), np.sin(0.8) * np.sin(3.1416), np.cos(0.8))
SQUARES = {  # in the mirror direction, at the distance 2
    "large": ((2.1314, -1.0, 0.6761), (2.1314, 1.0, 0.6761), (0.7380, -1.0, 2.1108)),
    "small": ((1.6437, -0.3, 1.1782), (1.6437, 0.3, 1.1782), (1.2257, -0.3, 1.6086)),
}
N = 2000


def ward(x, y, z, alpha):
    """f and p."""
    hx, hy, hz = x + VIEWER[0], y + VIEWER[1], z + VIEWER[2]
    size = np.sqrt(hx * hx + hy * hy + hz * hz)
    e = np.exp(-((hx / hz) ** 2 + (hy / hz) ** 2) / alpha**2) / (4 * np.pi * alpha**2)
    h_dot_i = (hx * VIEWER[0] + hy * VIEWER[1] + hz * VIEWER[2]) / size
    return e / np.sqrt(VIEWER[2] * z), e / (h_dot_i * (hz / size) ** 3)


def ashikhmin_shirley(x, y, z, nu, nv, reflectance):
    hx, hy, hz = x + VIEWER[0], y + VIEWER[1], z + VIEWER[2]
    size = np.sqrt(hx * hx + hy * hy + hz * hz)
    phi = np.arctan2(hy, hx)
    lobe = (hz / size) ** (nu * np.cos(phi) ** 2 + nv * np.sin(phi) ** 2)
    h_dot_i = (hx * VIEWER[0] + hy * VIEWER[1] + hz * VIEWER[2]) / size
    p = np.sqrt((nu + 1) * (nv + 1)) / (8 * np.pi) * lobe / h_dot_i
    fresnel = reflectance + (1 - reflectance) * (1 - h_dot_i) ** 5
    return p * fresnel / np.maximum(VIEWER[2], z), p


BRDFS = {
    "smooth": lambda x, y, z: ward(x, y, z, 0.05),
    "glossy": lambda x, y, z: ashikhmin_shirley(x, y, z, 1000, 100, 0.5),
    "rough": lambda x, y, z: ward(x, y, z, 0.5),
}


def light_of(square, brdf):
    corner, along, across = (np.array(v) for v in SQUARES[square])
    u, v = along - corner, across - corner
    normal = np.cross(u, v)
    area = np.linalg.norm(normal)
    height = abs(np.dot(normal / area, corner))
    places = (np.arange(N) + 0.5) / N
    omega, parts = 0.0, []
    for s in places:  # a row at a time
        x, y, z = (corner[i] + s * u[i] + places * v[i] for i in range(3))
        r = np.sqrt(x * x + y * y + z * z)
        dw = area / N**2 * height / r**3
        omega += dw.sum()
        f, p = BRDFS[brdf](x / r, y / r, z / r)
        parts.append((dw, f * z / r, p, r**3 / (area * height)))
    dw, f, p_b, p_a = (np.concatenate([part[i] for part in parts]) for i in range(4))
    return dw, f, 1 / omega, p_b, p_a, area


def moments(square, brdf):
    dw, f, p_l, p_b, p_a, _ = light_of(square, brdf)

    def integral(g):
        return float(np.sum(dw * g))

    def multi_sample(n_l, n_b, exponent):
        q_l, q_b = (n_l * p_l) ** exponent, (n_b * p_b) ** exponent
        w_l = q_l / (q_l + q_b)
        w_b = 1 - w_l
        return (integral((w_l * f) ** 2 / p_l) - integral(w_l * f) ** 2) / n_l + (
            integral((w_b * f) ** 2 / p_b) - integral(w_b * f) ** 2
        ) / n_b

    def one_sample(exponent):
        q_l, q_b = p_l**exponent, p_b**exponent
        w_l = q_l / (q_l + q_b)
        w_b = 1 - w_l
        return 2 * integral((w_l * f) ** 2 / p_l + (w_b * f) ** 2 / p_b) - mean**2

    mean = integral(f)
    light = integral(f * f / p_l) - mean**2
    by_area = integral(f * f / p_a) - mean**2
    by_brdf = integral(f * f / p_b) - mean**2
    of_light = integral(f * p_l / (p_l + p_b))
    return [mean, of_light, light, by_area, by_brdf, multi_sample(1, 1, 1), multi_sample(1, 1, 2),
            multi_sample(1, 3, 1), one_sample(1), one_sample(2)]


def mutants():
    dw, f, p_l, p_b, _, area = light_of("small", "glossy")

    def integral(g):
        return float(np.sum(dw * g))

    mean = integral(f)
    w_l = p_l / (p_l + p_b)
    w_b = 1 - w_l
    by_area = p_b / (1 / area + p_b)
    three = 3 * p_b / (p_l + 3 * p_b)
    four = 4 * p_b / (p_l + 4 * p_b)
    hit = integral(p_b)
    wrong = (1 / area) / (1 / area + p_b)
    return mean, {
        "weights_squared": integral((w_l**2 + w_b**2) * f),
        "brdf_unweighted": integral((w_l + 1) * f),
        "brdf_weight_of_light": integral(2 * w_l * f),
        "weights_exchanged": mean,
        "brdf_weight_by_area": integral((w_l + by_area) * f),
        "weights_by_area": mean,
        "light_density_by_area": integral(wrong * f * p_l * area) + integral(w_b * f),
        "brdf_divided_by_light_density": integral((w_l + w_b * p_b / p_l) * f),
        # With three samples of the BRDF.
        "brdf_weight_without_counts": integral((1 - three + w_b) * f),
        "weights_without_counts": mean,
        # With four: those that hit are averaged, where one does.
        "misses_not_counted": integral((1 - four) * f)
        + (1 - (1 - hit) ** 4) * integral(four * f) / hit,
        "no_selection_probability": 0.5 * mean,
    }


def under_a_ceiling(alpha):
    """The mean and the variance of f cos / p of Ward's half vectors, where light comes from everywhere:
    over t = tan theta_h / alpha, whose density is 2 t exp(-t^2), by Gauss and Legendre's rule, and over
    the angle around by the trapezoidal rule."""
    nodes, weights = np.polynomial.legendre.leggauss(1500)
    angle = 2 * np.pi * np.arange(1500) / 1500
    t, phi = np.meshgrid(3.5 * (nodes + 1), angle, indexing="ij")
    mass = 3.5 * weights[:, None] * 2 * t * np.exp(-t * t) / 1500
    tangent = alpha * t
    hz = 1 / np.sqrt(1 + tangent**2)
    hx, hy = tangent * hz * np.cos(phi), tangent * hz * np.sin(phi)
    h_dot_i = hx * VIEWER[0] + hy * VIEWER[1] + hz * VIEWER[2]
    z = np.maximum(0, 2 * h_dot_i * hz - VIEWER[2])
    weight = np.sqrt(z / VIEWER[2]) * h_dot_i * hz**3
    mean = np.sum(mass * weight)
    return mean, np.sum(mass * (weight - mean) ** 2)


what = sys.argv[1]
print("# /usr/bin/python3 tests/tables/make_direct_light.py %s" % what)
if what == "moments":
    print("square,brdf,radiance,part_of_light,light,area,brdf,balance,power,balance_1_3,one_sample,"
          "one_sample_power")
    for square, brdf in (("large", "smooth"), ("small", "glossy"), ("small", "rough")):
        print(",".join([square, brdf] + ["%.12g" % x for x in moments(square, brdf)]))
elif what == "ceiling":
    print("alpha,radiance,brdf")
    for alpha in (0.02, 0.05, 0.3):
        print("%g,%.9g,%.6g" % (alpha, *under_a_ceiling(alpha)))
else:
    print("mutant,relative_bias")
    mean, limits = mutants()
    for name, limit in limits.items():
        print("%s,%.6f" % (name, limit / mean - 1))
