"""Irradiance from a sky of radiance 1 + cos(theta), by two densities of directions: 5 pi / 3.

Assay starts it as `python3 mine.py uniform` and asks for observations on standard input. This file
needs no package. With Assay's package `assay` you write only functions that draw by `rng.random()`.
"""
import math
import random
import sys


# One sample f / p. Put your own estimator here; `draw()` gives its random numbers.
def uniform(draw):
    cosine = draw()  # p = 1 / (2 pi)
    return (1 + cosine) * cosine * 2 * math.pi


def cosine(draw):
    cosine = math.sqrt(draw())  # p = cosine / pi
    return (1 + cosine) * math.pi


sample = {"uniform": uniform, "cosine": cosine}[sys.argv[1]]
print("assay 1 text\nchannel irradiance\naverages\nbias unbiased\nready", flush=True)
for question in sys.stdin:
    high, low, first, count, samples = map(int, question.split())
    for index in range(first, first + count):
        # An observation depends on nothing but the key and its index.
        draw = random.Random(f"{high} {low} {index}").random
        print(sum(sample(draw) for _ in range(samples)) / samples)
    print(question, end="", flush=True)
