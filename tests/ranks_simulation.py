"""Simulates ranks with measured times: how busy rank 0 is, and what all together draw.

python3 tests/ranks_simulation.py --message 0 --block 14.4e-6 --blocks 61035 TIMES...
"""
import argparse
import heapq
import random

arguments = argparse.ArgumentParser()
arguments.add_argument("times", nargs="+", help="files of seconds of a block (ranks_messages.c)")
for name in ("message", "block", "latency"):  # rank 0's seconds for a batch, and for each block of it
    arguments.add_argument(f"--{name}", type=float, default=2e-5)
arguments.add_argument("--blocks", type=int)
given = arguments.parse_args()
measured = [float(line) for name in given.times for line in open(name)]
mean = sum(measured) / len(measured)
size = min(64, max(1, int(.005 / mean)))


def simulated(ranks):
    """Rank 0 serves whoever waits, and draws a block when nobody does."""
    rng, left, now, served, drawn = random.Random(1), given.blocks, 0.0, 0.0, 0
    free = [0.0] * ranks  # when a rank ends all that it has
    arrivals = [(0.0, rank, 0) for rank in range(1, ranks) for _ in range(2)]
    heapq.heapify(arrivals)
    while arrivals or left > 0:
        if left > 0 and (not arrivals or arrivals[0][0] > now):  # nobody waits
            now, left, drawn = now + rng.choice(measured) + given.block, left - 1, drawn + 1
            continue
        at, rank, blocks = heapq.heappop(arrivals)
        cost = given.message + given.block * blocks
        now, served = max(now, at) + cost, served + cost
        some = min(size, max(1, left // (2 * ranks)), left)
        if some > 0:
            left -= some
            free[rank] = max(free[rank], now + given.latency) + some * rng.choice(measured)
            heapq.heappush(arrivals, (free[rank] + given.latency, rank, some))
    return now, served


print(f"{len(measured)} batches measured: a block takes {1e6 * mean:.0f} us, a batch has {size}")
for ranks in (1, 4, 16, 64, 256, 1024, 4096):
    seconds, served = simulated(ranks)
    print(f"{ranks:5} ranks: speed-up {given.blocks * mean / seconds:7.1f}, rank 0 serves {served / seconds:6.1%}")
