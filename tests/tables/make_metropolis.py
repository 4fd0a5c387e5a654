#!/usr/bin/python3
"""Broken Metropolis chains, simulated once more: prints tests/tables/metropolis_mutants.csv.

No closed form is known of what most of them tend to, so that this is a second program, of many chains side
by side, with another generator; its means have standard errors. Chains of 200 steps from a bootstrap of 64.
"""
import sys

import numpy as np

CHAINS, BOOTSTRAP, STEPS = 16000, 64, 200
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
random = np.random.default_rng(1)


def uniform(count=CHAINS):
    return random.random(count)


def ratio(numerator, denominator, otherwise):
    return np.divide(numerator, denominator, out=np.full(CHAINS, float(otherwise)),
                     where=denominator > 0)


def gaussian(u, centre, width):
    return np.exp(-((u - centre) ** 2) / (2 * width * width))


class Target:
    """I, pixel and whether the second coordinate is looked at."""

    def __init__(self, name, pixels):
        self.name, self.pixels = name, pixels
        t = np.arange(pixels) / (pixels - 1)
        self.colours = np.stack([1 - 0.8 * t, 0 * t + 0.5, 0.2 + 0.8 * t], 1)
        self.elements = 3 * pixels if name == "coloured_peak" else pixels

    def pixel(self, u):
        if self.name == "branches":
            return (u * 32 * self.pixels).astype(int) % self.pixels
        return (u * self.pixels).astype(int)

    def looks_further(self, u):
        if self.name == "branches":
            return self.pixel(u) % 2 == 1
        return np.full(CHAINS, self.name != "boundary")

    def importance(self, u, v):
        if self.name == "boundary":
            return 0.02 + np.exp(-20 * u)
        if self.name == "branches":
            return np.where(self.pixel(u) % 2 == 1, 100 * gaussian(v, 0.5, 0.004), 1)
        peak = 0.05 + 0.5 * u + 40 * gaussian(u, 0.3, 0.02) * gaussian(v, 0.7, 0.02)
        if self.name == "peak":
            return peak
        return peak * (self.colours[self.pixel(u)] @ LUMINANCE)

    def add(self, image, pixel, weight, importance, from_pixel):
        """weight F to a pixel, F being that of `from_pixel`."""
        rows = np.arange(CHAINS)
        if self.elements == self.pixels:
            image[rows, pixel] += weight * importance
            return
        colour = self.colours[from_pixel]
        share = weight * importance / (colour @ LUMINANCE)
        for c in range(3):
            image[rows, 3 * pixel + c] += share * colour[:, c]


class Chains:
    """All chains' coordinates with the times that they are of, and the times of the states."""

    def __init__(self, target, mutant):
        self.target, self.mutant = target, mutant
        self.value = np.zeros((2, CHAINS))
        self.time = np.zeros((2, CHAINS), int)
        self.now = np.ones(CHAINS, int)
        self.last_large = np.ones(CHAINS, int)
        self.pixel = np.zeros(CHAINS, int)
        self.importance = np.zeros(CHAINS)

    def moved(self, u):
        xi = 2 * uniform(len(u)) - 1
        step = np.sign(xi) / 64 * np.exp(-np.log(16) * np.abs(xi))
        if self.mutant == "asymmetric":
            step = np.where((step < 0) & (uniform(len(u)) < 0.5), -step, step)
        if self.mutant == "clamped":
            return np.clip(u + step, 0, np.nextafter(1, 0))
        return (u + step) % 1.0

    def catch_up(self, k, mask):
        fresh = mask & (self.time[k] < self.last_large)
        if self.mutant == "not_freshened":
            fresh = mask & (self.time[k] == 0)
        self.value[k] = np.where(fresh, uniform(), self.value[k])
        self.time[k] = np.where(fresh, self.last_large, self.time[k])
        if self.mutant in ("not_freshened", "no_catching_up"):
            self.time[k] = np.where(mask, self.now, self.time[k])
        missed = np.flatnonzero(mask & (self.time[k] < self.now))
        while missed.size:
            self.value[k][missed] = self.moved(self.value[k][missed])
            self.time[k][missed] += 1
            missed = missed[self.time[k][missed] < self.now[missed]]

    def propose(self, large):
        """Moves the coordinates that are looked at; what they were, and which were."""
        old, seen = [], []
        for k in range(2):
            mask = np.full(CHAINS, True) if k == 0 else self.target.looks_further(self.value[0])
            self.catch_up(k, mask & ~large)
            old.append((self.value[k].copy(), self.time[k].copy()))
            new = np.where(large, uniform(), self.moved(self.value[k]))
            self.value[k] = np.where(mask, new, self.value[k])
            self.time[k] = np.where(mask, self.now + 1, self.time[k])
            seen.append(mask)
        return old, seen, self.target.pixel(self.value[0]), self.target.importance(*self.value)

    def settle(self, accepted, large, proposal):
        old, seen, pixel, importance = proposal
        for k in range(2):
            back = ~accepted & seen[k]
            if self.mutant == "large_not_saved":
                back &= ~large
            if self.mutant == "first_restored" and k == 1:
                back[:] = False
            self.value[k] = np.where(back, old[k][0], self.value[k])
            self.time[k] = np.where(back, old[k][1], self.time[k])
        dated = large & (accepted | (self.mutant == "large_time_on_rejection"))
        self.last_large = np.where(dated, self.now + 1, self.last_large)
        self.now = self.now + accepted
        self.pixel = np.where(accepted, pixel, self.pixel)
        self.importance = np.where(accepted, importance, self.importance)

    def start(self):
        total = np.zeros(CHAINS)
        large = np.full(CHAINS, True)
        for _ in range(BOOTSTRAP):
            proposal = self.propose(large)
            total += proposal[3]
            self.settle(uniform() * total < proposal[3], large, proposal)
        return total / BOOTSTRAP


def simulated(mutant, name, pixels, p_large):
    target = Target(name, pixels)
    multiple = mutant in ("current_pixel_multiple", "large_omitted", "large_always",
                          "normaliser_scaled_multiple", "sound_multiple")
    chains = Chains(target, mutant)
    b = chains.start()
    if mutant.startswith("normaliser_scaled"):
        b = 1.05 * b
    if mutant == "other_normaliser":
        b = sum(target.importance(uniform(), uniform()) for _ in range(BOOTSTRAP)) / BOOTSTRAP
    image, steps = np.zeros((CHAINS, target.elements)), np.zeros(CHAINS)
    for _ in range(STEPS):
        large = uniform() < p_large
        proposal = chains.propose(large)
        _, _, y, i_y = proposal
        x, i_x = chains.pixel, chains.importance
        a = ratio(i_x, i_y, 1) if mutant == "inverted_ratio" else ratio(i_y, i_x, 1)
        if mutant != "unbounded_ratio":
            a = np.minimum(1, a)
        accepted = uniform() < a
        counted = np.full(CHAINS, 1.0)
        if multiple:
            flag = {"large_omitted": 0, "large_always": 1}.get(mutant, large)
            w_y, w_x = (a + flag) / (i_y / b + p_large), (1 - a) / (i_x / b + p_large)
        elif mutant == "rejected_not_counted":
            w_y, w_x, counted = ratio(accepted * b, i_y, 0), 0, 1.0 * accepted
        else:
            w_y, w_x = ratio(a * b, i_y, 0), ratio((1 - a) * b, i_x, 0)
        if mutant == "current_dropped":
            w_x = 0 * w_y
        target.add(image, x if mutant.startswith("current_pixel") else y, w_y, i_y, y)
        target.add(image, x, w_x, i_x, x)
        steps += counted
        chains.settle(accepted, large, proposal)
    image *= target.pixels / np.maximum(steps, 1)[:, None]
    return image.mean(0), image.std(0) / np.sqrt(CHAINS)


peak, border, rare_branches = ("peak", 8, 0.5), ("boundary", 64, 0.1), ("branches", 2, 0.02)
print("# /usr/bin/python3 tests/tables/make_metropolis.py > tests/tables/metropolis_mutants.csv")
print("mutant,target,pixels,p_large,element,mean,standard_error")
for mutant, scene in [("sound", peak), ("sound", rare_branches), ("sound_multiple", peak)] + [
        (mutant, peak) for mutant in (
            "asymmetric", "inverted_ratio", "unbounded_ratio", "rejected_not_counted",
            "current_dropped", "current_pixel_multiple", "large_omitted", "large_always",
            "normaliser_scaled_multiple", "other_normaliser", "first_restored", "large_not_saved",
            "large_time_on_rejection")] + [
        ("current_pixel", ("coloured_peak", 8, 0.5)), ("clamped", border),
        ("not_freshened", rare_branches), ("no_catching_up", rare_branches)]:
    means, errors = simulated(mutant, *scene)
    for i, (mean, error) in enumerate(zip(means, errors)):
        print("%s,%s,%d,%g,%d,%.6g,%.3g" % (mutant, *scene, i, mean, error))
    sys.stdout.flush()
