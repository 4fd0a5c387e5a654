#!/usr/bin/python3
"""What tests/bench/image_bench measures, with scipy: image_scipy.py [WIDTH HEIGHT]"""
import sys
import time

import numpy
from scipy.stats import ttest_ind

WIDTH, HEIGHT = (int(sys.argv[1]), int(sys.argv[2])) if len(sys.argv) > 2 else (1920, 1080)
SHAPE = (64, HEIGHT, WIDTH, 3)

random = numpy.random.default_rng(1)
a = random.random(SHAPE, dtype=numpy.float32) ** 2
b = random.random(SHAPE, dtype=numpy.float32) ** 2
times = []
for _ in range(3):
    start = time.process_time()
    ttest_ind(a, b, axis=0, equal_var=False)
    times.append(time.process_time() - start)
print(f"scipy ttest_ind of 2 x 64 images of {WIDTH} x {HEIGHT} x 3 floats: "
      f"{sorted(times)[1]:.2f} s of processor time, one thread")
