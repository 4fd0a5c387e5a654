#!/usr/bin/env python3
"""Reference values for tests/stats, from mpmath (40 digits) and scipy. Run in this folder:
python3 make_tables.py. Values are logarithms of tails unless a table says otherwise."""
import math

import mpmath as mp
import numpy as np
from scipy import stats

mp.mp.dps = 40
COMMAND = "# python3 tests/tables/make_tables.py"


def write(name, header, rows):
    with open(name + ".csv", "w") as out:
        out.write(COMMAND + "\n" + header + "\n")
        for row in rows:
            out.write(",".join(v if isinstance(v, str) else number(v) for v in row) + "\n")


def number(v):
    if isinstance(v, (int, np.integer)):
        return str(int(v))
    if isinstance(v, float):
        return repr(v)
    return mp.nstr(v, 25)


def both(lower, upper):
    """Logarithms of the two tails from whichever is small and accurate."""
    return [mp.log(lower), mp.log(upper)]


def deep(make):
    """Raise the precision until two passes agree to 25 digits of the logarithm."""
    previous, digits = None, 60
    while digits < 5000:
        with mp.workdps(digits):
            try:
                value = make()
            except (ValueError, ZeroDivisionError):
                value = None
        if value is not None and previous is not None:
            if all(abs(a - b) < mp.mpf(10) ** -25 * (1 + abs(a)) for a, b in zip(value, previous)):
                return value
        previous, digits = value, digits * 2
    raise RuntimeError("no convergence")


# Incomplete functions as positive series in logarithms: no hypergeometric limits to trip over.
def log_beta_lower(a, b, x):
    """ln I_x(a, b) from DLMF 8.17.8 (x at most the mean converges geometrically)."""
    a, b, x = mp.mpf(a), mp.mpf(b), mp.mpf(x)
    term = total = mp.mpf(1)
    k = 0
    while term > total * mp.mpf(10) ** (-mp.mp.dps):
        term *= (a + b + k) * x / (a + 1 + k)
        total += term
        k += 1
        if k > 4000000:
            raise RuntimeError("slow series")
    return a * mp.log(x) + b * mp.log(1 - x) - mp.log(a) - (
        mp.loggamma(a) + mp.loggamma(b) - mp.loggamma(a + b)) + mp.log(total)


def log_gamma_lower(a, x):
    a, x = mp.mpf(a), mp.mpf(x)
    term = total = mp.mpf(1)
    k = 1
    while term > total * mp.mpf(10) ** (-mp.mp.dps):
        term *= x / (a + k)
        total += term
        k += 1
    return a * mp.log(x) - x - mp.loggamma(a + 1) + mp.log(total)


def log_gamma_upper(a, x):
    """ln Q(a, x) by Legendre's continued fraction, from the back, far enough for 40 digits."""
    a, x = mp.mpf(a), mp.mpf(x)
    depth = 4000
    f = x + 2 * depth + 1 - a
    for k in range(depth, 0, -1):
        f = x + 2 * (k - 1) + 1 - a - k * (k - a) / f
    return a * mp.log(x) - x - mp.loggamma(a) - mp.log(f)


def complement(log_p):
    return mp.log1p(-mp.exp(log_p)) if log_p > -60 else -mp.exp(log_p)


def normal_rows():
    for x in [0, 1e-9, 0.3, 1, 2.5, 5, 8, 13, 29.9, 30.1, 37, 38.5, 60, 400, 1500, 1e5]:
        for sign in (1, -1):
            q = mp.log(mp.erfc(mp.mpf(x) / mp.sqrt(2)) / 2)
            p = complement(q)
            yield [float(sign * x)] + ([p, q] if sign > 0 else [q, p])


def t_rows():
    for nu in [1, 2.5, 9, 10.9076975261363, 99, 999, 12345.5, 1e6, 1e9]:
        for t in [0, 1e-6, 0.4, 1.5, 3, 6, 12, 30, 100, 1000]:
            n, s = mp.mpf(nu), mp.mpf(t)
            if t == 0:
                q = mp.log(mp.mpf(1) / 2)
            elif s * s < 1 and nu > 0:
                # P(|T| < t) by the series in t^2 / (nu + t^2)
                q = mp.log((1 - mp.exp(log_beta_lower(0.5, n / 2, s * s / (n + s * s)))) / 2)
            else:
                try:
                    q = log_beta_lower(n / 2, mp.mpf(1) / 2, n / (n + s * s)) - mp.log(2)
                except RuntimeError:
                    continue
            yield [float(t), float(nu), complement(q), q]
            if t:
                yield [float(-t), float(nu), q, complement(q)]


def chi_rows():
    for nu in [1, 2, 7.5, 29, 400, 10000, 1000000]:
        for ratio in [1e-3, 0.05, 0.3, 0.7, 0.9, 0.99, 1, 1.01, 1.1, 1.5, 2, 4, 12, 60]:
            x = nu * ratio
            if ratio <= 1:
                low = log_gamma_lower(mp.mpf(nu) / 2, mp.mpf(x) / 2)
                yield [x, float(nu), low, complement(low)]
            elif ratio < 1.5 or nu < 3:
                # From one minus the lower tail at a precision that leaves 40 digits.
                def make():
                    value = log_gamma_lower(mp.mpf(nu) / 2, mp.mpf(x) / 2)
                    return [value, mp.log(1 - mp.exp(value))]
                yield [x, float(nu)] + deep(make)
            else:
                up = log_gamma_upper(mp.mpf(nu) / 2, mp.mpf(x) / 2)
                yield [x, float(nu), complement(up), up]


def f_rows():
    for d1, d2 in [(1, 1), (9, 6), (29, 39), (99, 1999), (5000, 5000), (100000, 300000)]:
        for f in [1e-4, 0.02, 0.3, 0.8, 0.97, 1.02, 1.3, 3, 12, 200]:
            for value in ([f] if f < 1 else [f]):
                a, b = mp.mpf(d1) / 2, mp.mpf(d2) / 2
                x = mp.mpf(d1) * mp.mpf(value) / (d1 * mp.mpf(value) + d2)
                try:
                    if x < a / (a + b):
                        low = log_beta_lower(a, b, x)
                        yield [value, float(d1), float(d2), low, complement(low)]
                    else:
                        up = log_beta_lower(b, a, 1 - x)
                        yield [value, float(d1), float(d2), complement(up), up]
                except RuntimeError:
                    continue


def log_binomial_tail(k, n, p, direction):
    """ln of the sum of the probabilities from k outwards; exact 0 for a full sum."""
    if (direction < 0 and k == n) or (direction > 0 and k == 0):
        return mp.mpf(0)
    p = mp.mpf(p)
    first = mp.log(mp.binomial(n, k)) + k * mp.log(p) + (n - k) * mp.log(1 - p)
    term = total = mp.mpf(1)
    odds = p / (1 - p)
    i = k
    while (i > 0 if direction < 0 else i < n) and term > total * mp.mpf(10) ** -45:
        term *= (mp.mpf(i) / (n - i + 1) / odds) if direction < 0 else (mp.mpf(n - i) / (i + 1) * odds)
        total += term
        i += direction
    return first + mp.log(total)


def binomial_rows():
    for n, p in [(1, 0.3), (10, 0.5), (60, 0.01), (1000, 0.25), (100000, 1e-5), (100000, 0.4)]:
        for k in sorted({0, 1, n // 7, int(n * p), int(n * p) + 1, int(n * 0.45), n - 1, n}):
            low = log_binomial_tail(k, n, p, -1)
            up = log_binomial_tail(k, n, p, +1)
            # A nearly certain tail is accurate by its complement.
            if low > -0.1 and k < n:
                low = complement(log_binomial_tail(k + 1, n, p, +1))
            if up > -0.1 and k > 0:
                up = complement(log_binomial_tail(k - 1, n, p, -1))
            yield [k, n, float(p), low, up]


def noncentral_chi_rows():
    for nu, ncp in [(1, 0.5), (5, 10), (63, 40), (63, 4000), (200, 1e5)]:
        mean, sd = nu + ncp, math.sqrt(2 * (nu + 2 * ncp))
        for k in [-60, -20, -8, -2, 0, 1, 3, 10, 40, 150]:
            x = mean + k * sd
            if x <= 0:
                continue
            # Poisson mixture of lower tails, positive terms at 60 digits; uppers from continued fractions.
            half, rate, y = mp.mpf(nu) / 2, mp.mpf(ncp) / 2, mp.mpf(x) / 2
            centre = int(math.sqrt(ncp / 2 * x / 2)) if k != 0 else int(ncp / 2)
            width = int(60 + 16 * math.sqrt(centre + 30))
            lows = range(max(0, centre - width), centre + width)
            if k <= 0:
                j = lows[-1]
                p = mp.exp(log_gamma_lower(half + j, y))
                gamma = mp.exp((half + j - 1) * mp.log(y) - y - mp.loggamma(half + j))
                w = mp.exp(j * mp.log(rate) - rate - mp.loggamma(j + 1))
                total = mp.mpf(0)
                for j in reversed(lows):
                    total += w * p
                    p += gamma
                    gamma *= (half + j - 1) / y
                    w *= j / rate
                low = mp.log(total)
                yield [x, float(nu), float(ncp), low, complement(low)]
            else:
                j = lows[0]
                with mp.workdps(400):
                    q = 1 - mp.exp(log_gamma_lower(half + j, y))
                q = q if q > mp.mpf(10) ** -300 else mp.exp(log_gamma_upper(half + j, y))
                gamma = mp.exp((half + j) * mp.log(y) - y - mp.loggamma(half + j + 1))
                w = mp.exp(j * mp.log(rate) - rate - mp.loggamma(j + 1))
                total = mp.mpf(0)
                for j in lows:
                    total += w * q
                    q += gamma
                    gamma *= y / (half + j + 1)
                    w *= rate / (j + 1)
                up = mp.log(total)
                yield [x, float(nu), float(ncp), complement(up), up]


def noncentral_t_rows():
    mp.mp.dps = 30
    usual = [-40, -5, -1, 0.5, 2.5, 6, 15, 60]
    for nu, delta, places in [(3, 1, usual), (19, 2.2360679774997896, usual), (999, 4, usual),
                              (20000, -3, usual), (19, 30, usual), (14824, 487.2, [132.6, 300])]:
        for t in places:
            n = mp.mpf(nu)

            def term(u, side):
                s = mp.exp(u)
                log_f = mp.log(2) + n / 2 * mp.log(n / 2) - mp.loggamma(n / 2) + n * u - n * s * s / 2
                z = t * s - delta
                return mp.exp(log_f) * mp.erfc(side * z / mp.sqrt(2)) / 2

            side = 1 if t >= delta else -1
            # Trapezoid in ln s: spectral; 4000 points over all that matters.
            grid = np.linspace(-30 if nu < 10 else -12 / math.sqrt(nu) * 6, 2.5 if nu < 10 else
                               max(12 / math.sqrt(nu) * 3,
                                   math.log(delta / t) if delta / t > 1 else 0), 1500)
            values = [term(mp.mpf(float(u)), side) for u in grid]
            peak = max(range(len(values)), key=lambda i: values[i])
            # Second pass, centred on where the integrand lives.
            keep = [i for i, v in enumerate(values) if v > values[peak] * mp.mpf(10) ** -32]
            a, b = grid[max(0, keep[0] - 1)], grid[min(len(grid) - 1, keep[-1] + 1)]
            h = mp.mpf(float(b - a)) / 800
            total = h * sum(term(mp.mpf(float(a)) + h * i, side) for i in range(801))
            p = mp.log(total)
            yield [float(t), float(nu), float(delta)] + (
                [complement(p), p] if side > 0 else [p, complement(p)])
    yield from noncentral_t_rows_of_few_degrees()
    mp.mp.dps = 40


def noncentral_t_rows_of_few_degrees():
    """The law of s is wide there and P(Z >= t s - delta) falls within 1 / delta of ln s = ln(delta / t)."""
    for nu, delta, t in [(1, 3000, 3183), (1, 3000, 1e6), (0.5, 3, 5), (2, 40, 41)]:
        n = mp.mpf(nu)

        def term(u):
            s = mp.exp(u)
            log_f = mp.log(2) + n / 2 * mp.log(n / 2) - mp.loggamma(n / 2) + n * u - n * s * s / 2
            return mp.exp(log_f) * mp.erfc((t * s - delta) / mp.sqrt(2)) / 2

        falls = mp.log(mp.mpf(delta) / t)
        near = [falls + mp.mpf(k) / delta for k in (-40, -8, -3, 0, 3, 8, 40)]
        outer = [-160 / n, -80 / n, -20 / n, mp.mpf(5)]
        p = mp.log(mp.quad(term, sorted(outer + [u for u in near if outer[0] < u < outer[-1]])))
        yield [float(t), float(nu), float(delta), complement(p), p]


def kolmogorov_exact(n, d):
    """P(D >= d), Durbin's matrix at 60 digits."""
    with mp.workdps(60):
        d = mp.mpf(d)
        k = int(mp.floor(n * d)) + 1
        h = k - n * d
        m = 2 * k - 1
        H = mp.matrix(m, m)
        for i in range(m):
            for j in range(min(i + 2, m)):
                H[i, j] = mp.mpf(1)
        for i in range(m):
            H[i, 0] -= h ** (i + 1)
            H[m - 1, i] -= h ** (m - i)
        if 2 * h > 1:
            H[m - 1, 0] += (2 * h - 1) ** m
        for i in range(m):
            for j in range(min(i + 2, m)):
                if i - j + 1 > 0:
                    H[i, j] /= mp.factorial(i - j + 1)
        result, base, e = mp.eye(m), H, n
        while e:
            if e & 1:
                result = result * base
            e >>= 1
            if e:
                base = base * base
        return 1 - result[k - 1, k - 1] * mp.factorial(n) / mp.mpf(n) ** n


def kolmogorov_rows():
    for n, d in [(1, 0.3), (1, 0.8), (2, 0.3), (2, 0.6), (3, 0.2), (5, 0.35), (10, 0.12), (10, 0.3),
                 (10, 0.7), (30, 0.09), (30, 0.2), (30, 0.45), (100, 0.05), (100, 0.1), (100, 0.2),
                 (141, 0.06), (141, 0.1), (141, 0.16),
                 (500, 0.016), (500, 0.036), (500, 0.06), (1000, 0.012), (1000, 0.03)]:
        yield [d, n, kolmogorov_exact(n, d), "durbin-60-digits"]
    # From n = 141 on scipy's body is the Pelz-Good expansion, off by 0.05 / n^2 (1.8e-7 at n = 500).
    for n in [5000, 20000, 100000, 1000000]:
        for z in [0.35, 0.5, 0.8, 1.0, 1.3, 1.45]:
            d = z / math.sqrt(n)
            yield [d, n, float(stats.kstwo.sf(d, n)), "scipy"]
        for z in [2.0, 3.0, 6.0, 12.0]:
            d = z / math.sqrt(n)
            yield [d, n, float(stats.kstwo.sf(d, n)), "scipy-tail"]


def smirnov_fraction(m, n, steps):
    """P(D >= steps / lcm) by exact counting of lattice paths that stay inside."""
    g = math.gcd(m, n)
    inside = [0] * (n + 1)
    for i in range(m + 1):
        for j in range(n + 1):
            ok = abs(i * (n // g) - j * (m // g)) < steps
            if i == 0 and j == 0:
                inside[j] = 1 if ok else 0
            else:
                inside[j] = ((inside[j] if i else 0) + (inside[j - 1] if j else 0)) if ok else 0
    total = math.comb(m + n, m)
    return mp.log(mp.mpf(total - inside[n]) / mp.mpf(total))


def smirnov_rows():
    for m, n in [(1, 1), (3, 5), (7, 10), (10, 10), (50, 60), (200, 200), (37, 400), (333, 334),
                 (600, 601), (900, 1000)]:
        step = m * n // math.gcd(m, n)
        for part in [0.02, 0.1, 0.25, 0.5, 0.8, 1.0]:
            steps = max(1, round(part * step))
            yield [steps, m, n, smirnov_fraction(m, n, steps)]


def tests_rows():
    """Data sets by formula; statistics and two-sided or one-sided p-values by scipy."""
    def sample(k, size):
        i = np.arange(1, size + 1)
        return np.cos(i * (0.7 + 0.1 * k)) * (1 + 0.05 * k * i % 3) + 0.01 * k * i + 0.3 * k

    for k in range(1, 7):
        n, m = 6 + 7 * k, 9 + 4 * k
        x, y = sample(k, n), sample(k + 3, m)
        null = 0.2 * k
        t = stats.ttest_1samp(x, null)
        w = stats.ttest_ind(x, y, equal_var=False)
        wl = stats.ttest_ind(x, y, equal_var=False, alternative="less")
        wg = stats.ttest_ind(x, y, equal_var=False, alternative="greater")
        chi = (n - 1) * np.var(x, ddof=1) / (0.4 + 0.1 * k)
        f = np.var(x, ddof=1) / np.var(y, ddof=1)
        ks1 = stats.kstest(x, "norm", args=(0.3 * k, 1.2), method="exact")
        ks2 = stats.ks_2samp(x, y, method="exact")
        yield [k, n, m] + [float(v) for v in (
            t.statistic, t.pvalue, w.statistic, w.pvalue, wl.pvalue, wg.pvalue,
            stats.chi2.sf(chi, n - 1), stats.chi2.cdf(chi, n - 1), stats.f.sf(f, n - 1, m - 1),
            stats.f.cdf(f, n - 1, m - 1), ks1.statistic, ks1.pvalue, ks2.statistic, ks2.pvalue)]


if __name__ == "__main__":
    import sys
    write_all = write

    def write(name, header, rows):
        if len(sys.argv) < 2 or name in sys.argv[1:]:
            write_all(name, header, rows)

    write("normal", "x,log_lower,log_upper", normal_rows())
    write("student_t", "t,nu,log_lower,log_upper", t_rows())
    write("chi_square", "x,nu,log_lower,log_upper", chi_rows())
    write("f", "f,nu1,nu2,log_lower,log_upper", f_rows())
    write("binomial", "k,n,p,log_lower,log_upper", binomial_rows())
    write("noncentral_chi_square", "x,nu,ncp,log_lower,log_upper", noncentral_chi_rows())
    write("noncentral_t", "t,nu,ncp,log_lower,log_upper", noncentral_t_rows())
    write("kolmogorov", "d,n,upper_tail,source", kolmogorov_rows())
    write("smirnov", "steps,m,n,log_upper", smirnov_rows())
    write("tests", "k,n,m,t,t_two_sided,welch,welch_two_sided,welch_less,welch_greater,chi_upper,"
          "chi_lower,f_upper,f_lower,ks1,ks1_p,ks2,ks2_p", tests_rows())
