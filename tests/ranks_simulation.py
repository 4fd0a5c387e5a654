"""Simulates ranks with measured times: how busy rank 0 is, and what all together draw.

python3 tests/ranks_simulation.py SECONDS_A_BLOCK_ON_RANK_0 BLOCKS TIMES...
"""
import heapq
import random
import sys

fold, blocks_in_all, latency = float(sys.argv[1]), int(sys.argv[2]), 2e-5
measured = [float(line) for name in sys.argv[3:] for line in open(name)]
mean = sum(measured) / len(measured)
size = min(64, max(1, int(.005 / mean)))


def simulated(ranks):
    """Rank 0 serves whoever waits, and draws a block when nobody does."""
    rng, left, now, served, drawn = random.Random(1), blocks_in_all, 0.0, 0.0, 0
    free = [0.0] * ranks  # when a rank ends all that it has
    arrivals = [(0.0, rank, 0) for rank in range(1, ranks) for _ in range(2)]
    heapq.heapify(arrivals)
    while arrivals or left > 0:
        if left > 0 and (not arrivals or arrivals[0][0] > now):  # nobody waits
            now, left, drawn = now + rng.choice(measured) + fold, left - 1, drawn + 1
            continue
        at, rank, blocks = heapq.heappop(arrivals)
        cost = fold * blocks
        now, served = max(now, at) + cost, served + cost
        some = min(size, max(1, left // (2 * ranks)), left)
        if some > 0:
            left -= some
            free[rank] = max(free[rank], now + latency) + some * rng.choice(measured)
            heapq.heappush(arrivals, (free[rank] + latency, rank, some))
    return now, served


print(f"{len(measured)} batches measured: a block takes {1e6 * mean:.0f} us, a batch has {size}")
for ranks in (1, 4, 16, 64, 256, 1024, 4096):
    seconds, served = simulated(ranks)
    print(f"{ranks:5} ranks: speed-up {blocks_in_all * mean / seconds:7.1f}, rank 0 serves {served / seconds:6.1%}")
