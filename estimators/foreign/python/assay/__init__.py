"""Estimators in Python for Assay, and claims about them as tests of pytest."""

from assay.claims import claim
from assay.declaration import Channel, Image, Sampler, estimator
from assay.protocol import serve
from assay.stream import Stream

__all__ = ["Channel", "Image", "Sampler", "Stream", "claim", "estimator", "serve"]
