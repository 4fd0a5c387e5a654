"""The area of the unit disc by darts, as an estimator for Assay's plugin `process`.

The package `assay` speaks the protocol: pip install ./estimators/foreign/python
"""
import assay


def area(rng):
    """A primary estimate: 4 times the indicator of the disc, at a uniform point of [-1, 1]^2."""
    x = 2 * rng.random() - 1
    y = 2 * rng.random() - 1
    return 4 if x * x + y * y < 1 else 0


assay.serve(area, channels=[assay.Channel("area", low=0, high=4)], bias="unbiased")
