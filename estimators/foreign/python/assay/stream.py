"""The random numbers of one observation."""

from __future__ import annotations

import random
import typing

if typing.TYPE_CHECKING:
    import numpy

_RENDER_SEEDS = 2**31 - 1  # a prime


class Stream(random.Random):
    """A `random.Random` whose numbers are a function of `key` and `index` alone.

    key:    64 bits, from the run's seed, the estimator and its parameters
    index:  number of the observation, from 0
    rays:   count here the rays that the observation takes, if the estimator declares `rays`
    """

    key: int = 0
    index: int = 0
    rays: int = 0
    _numpy: numpy.random.Generator | None = None

    def begin(self, key: int, index: int) -> None:
        """Goes to the first number of an observation."""
        self.key, self.index, self.rays, self._numpy = key, index, 0, None
        self.seed(key << 64 | index)

    @property
    def numpy(self) -> numpy.random.Generator:
        """numpy's generator for this observation: Philox with `key` and `index` as its key."""
        if self._numpy is None:
            import numpy

            key = numpy.array([self.key, self.index], dtype=numpy.uint64)
            self._numpy = numpy.random.Generator(numpy.random.Philox(key=key))
        return self._numpy

    @property
    def render_seed(self) -> int:
        """A seed for a renderer, from 1 to p = 2^31 - 1: 1 + 630360016 (key + index) mod p.

        The first p observations of a key have different seeds. The plugin `command` has the same.
        """
        return 1 + 630360016 * ((self.key + self.index) % _RENDER_SEEDS) % _RENDER_SEEDS
