"""What an estimator declares of itself, and the lines of the protocol's hello that say it."""

from __future__ import annotations

import inspect
import typing
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from assay.stream import Stream

Draw = Sequence[typing.Any]  # (point, density), or (point, density, weight)


def _facts(**facts: float | None) -> str:
    return "".join(f" {name} {float(value)!r}" for name, value in facts.items() if value is not None)


@dataclass(frozen=True)
class Channel:
    """One number of an observation, with what is known exactly of it.

    mean:        expectation of the number
    error:       standard error of `mean`
    variance:    variance of one primary
    low, high:   range of the number; a value outside is an error
    rounding:    relative error of the number itself
    diagnostic:  tested only where a claim names the channel
    """

    name: str
    mean: float | None = None
    error: float | None = None
    variance: float | None = None
    low: float | None = None
    high: float | None = None
    rounding: float | None = None
    diagnostic: bool = False

    def line(self) -> str:
        facts = _facts(mean=self.mean, error=self.error, variance=self.variance,
                       low=self.low, high=self.high, rounding=self.rounding)
        return f"channel {self.name}{facts}{' diagnostic' if self.diagnostic else ''}\n"


@dataclass(frozen=True)
class Image:
    """The shape of a picture.

    width, height:  in pixels
    components:     names of the numbers of a pixel, such as R, G, B
    low, high:      range of every number
    independent:    True if the pixels of one picture are independent
    """

    width: int
    height: int
    components: Sequence[str] = ("R", "G", "B")
    low: float | None = None
    high: float | None = None
    independent: bool = False

    @property
    def shape(self) -> tuple[int, ...]:
        """(height, width, components), or (height, width) of a picture of one component."""
        many = (len(self.components),) if len(self.components) > 1 else ()
        return (self.height, self.width, *many)

    def line(self) -> str:
        text = f"image {self.width} {self.height} {' '.join(self.components)}\n"
        if self.independent:
            text += "independent\n"
        if self.low is not None or self.high is not None:
            low = "-inf" if self.low is None else repr(float(self.low))
            text += f"range {low} {'inf' if self.high is None else repr(float(self.high))}\n"
        return text


@dataclass(frozen=True)
class Sampler:
    """A source of points with the density it claims; a claim names it `estimator.name`.

    domain:    interval (from `low` to `high`), square [0, 1]^2, triangle (u, v >= 0, u + v <= 1),
               hemisphere (unit vectors with z >= 0) or sphere; densities are per length, area du dv
               or solid angle
    draw:      draw(rng) is (point, density, weight), or None without a point
    density:   density(point) integrates to 1 minus the probability of drawing no point
    evaluate:  evaluate(point) = weight * density, the function whose integral the weight estimates;
               without it a draw is (point, density), and its weight is 1
    rounding:  relative rounding of densities and weights; default 1e-9

    A point of an interval is a number, another a tuple of two (u, v) or three (x, y, z) numbers.
    """

    name: str
    domain: str
    draw: Callable[[Stream], Draw | None]
    density: Callable[[typing.Any], float]
    evaluate: Callable[[typing.Any], float] | None = None
    low: float = 0
    high: float = 1
    rounding: float | None = None

    @property
    def dimensions(self) -> int:
        return {"interval": 1, "square": 2, "triangle": 2}.get(self.domain, 3)

    def line(self) -> str:
        bounds = _facts(low=self.low, high=self.high) if self.domain == "interval" else ""
        return f"sampler {self.name} {self.domain}{bounds}{_facts(rounding=self.rounding)}\n"


@dataclass(frozen=True)
class Declaration:
    """The arguments of `estimator` and of `serve`, which explains them."""

    channels: Sequence[str | Channel] = ()
    image: Image | None = None
    averages: bool | None = None
    bias: str | None = None
    rays: bool = False
    samplers: Sequence[Sampler] = ()
    suite: dict[str, typing.Any] = field(default_factory=dict)

    def all_channels(self) -> list[Channel]:
        """Those beside an image, or those of the observation: one called `value` if none is named."""
        named = [Channel(each) if isinstance(each, str) else each for each in self.channels]
        return named if named or self.image else [Channel("value")]

    def hello(self, averages: bool) -> str:
        text = "assay 1 binary\n" + (self.image.line() if self.image else "")
        text += "".join(channel.line() for channel in self.all_channels())
        text += "averages\n" if averages else ""
        text += f"bias {self.bias}\n" if self.bias else ""
        text += "rays\n" if self.rays else ""
        return text + "".join(sampler.line() for sampler in self.samplers) + "ready\n"


Function = typing.TypeVar("Function", bound=Callable[..., typing.Any])


def estimator(**declared: typing.Any) -> Callable[[Function], Function]:
    """Declares what `serve` would be told, for a function that claims are about.

    Keys of the suite's entry, `primaries`, `timeout` and `memory`, may stand here too.
    """
    suite = {key: declared.pop(key) for key in ("primaries", "timeout", "memory") if key in declared}

    def declare(function: Function) -> Function:
        function.__assay_declaration__ = Declaration(**declared, suite=suite)  # type: ignore[attr-defined]
        return function

    return declare


def declaration_of(function: Callable[..., typing.Any]) -> Declaration:
    return getattr(function, "__assay_declaration__", None) or Declaration()


_READERS: dict[typing.Any, Callable[[str], typing.Any]] = {
    int: int, float: float, str: str,
    bool: lambda word: {"true": True, "false": False}[word.lower()]}


def takes_primaries(function: Callable[..., typing.Any]) -> bool:
    """True of `estimate(rng, primaries)`, False of `estimate(rng)`; TypeError for others."""
    name = getattr(function, "__name__", "estimate")
    positional = [p for p in inspect.signature(function).parameters.values()
                  if p.kind not in (p.KEYWORD_ONLY, p.VAR_KEYWORD)]
    if not positional:
        raise TypeError(f"`{name}` takes no argument: write `def {name}(rng):` and draw from `rng`")
    others = [p.name for p in positional if p.default is p.empty and p.kind is not p.VAR_POSITIONAL][1:]
    unknown = [other for other in others if other != "primaries"]
    if unknown:
        raise TypeError(f"`{name}` has the parameter `{unknown[0]}` without a value: "
                        "give it a default value, or write `*` before it; only `primaries` is given")
    return bool(others)


def parameters_of(function: Callable[..., typing.Any], words: Sequence[str]) -> dict[str, typing.Any]:
    """The suite's words `name=value` as the function's parameters; ValueError for a mistake.

    Parameters are those with a default value or behind a `*`. Annotation or default give the type:
    float, int, bool or str.
    """
    known = {p.name: p for p in inspect.signature(function).parameters.values()
             if p.kind == p.KEYWORD_ONLY
             or (p.default is not p.empty and p.kind == p.POSITIONAL_OR_KEYWORD)}
    values: dict[str, typing.Any] = {}
    for word in words:
        name, _, text = word.partition("=")
        if name not in known:
            names = ", ".join(known) or "none"
            raise ValueError(f"there is no parameter `{word}`; the estimator's are: {names}")
        values[name] = _read(known[name], text)
    missing = [p.name for p in known.values() if p.default is p.empty and p.name not in values]
    if missing:
        raise ValueError(f"the parameter `{missing[0]}` is missing: add `{missing[0]}=VALUE` to the "
                         "command, or give it a default value; fixtures do not fill it")
    return values


def _read(parameter: inspect.Parameter, text: str) -> typing.Any:
    names = {str(kind.__name__): kind for kind in _READERS}
    kind = names.get(parameter.annotation, parameter.annotation)
    if kind not in _READERS:
        kind = type(parameter.default) if type(parameter.default) in _READERS else str
    try:
        return _READERS[kind](text)
    except (KeyError, ValueError):
        raise ValueError(f"the parameter `{parameter.name}={text}` is no {kind.__name__}") from None
