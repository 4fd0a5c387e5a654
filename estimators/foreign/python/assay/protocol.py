"""The pipe protocol of Assay's plugin `process`, which ../README.md states."""

from __future__ import annotations

import math
import os
import reprlib
import struct
import sys
import traceback
import typing
from collections.abc import Callable, Sequence

from assay.declaration import (Channel, Declaration, Image, Sampler, declaration_of,
                               parameters_of, takes_primaries)
from assay.stream import Stream


def serve(estimate: Callable[..., typing.Any], *,
          channels: Sequence[str | Channel] = (),
          image: Image | None = None,
          averages: bool | None = None,
          bias: str | None = None,
          rays: bool = False,
          samplers: Sequence[Sampler] = (),
          arguments: Sequence[str] | None = None,
          output: int = 1) -> None:
    """Answers Assay's questions until it has no more. What is declared here replaces `estimator`.

    estimate:   `estimate(rng)` is one primary estimate f(x) / p(x); observations are means of many.
                `estimate(rng, primaries)` is an observation made of so many primaries.
                It returns a number, or a number for each channel, or a picture (nested lists or an
                array of `image.shape`), or a picture and a number for each further channel.
                Its other parameters are the suite's, `command: [python3, mine.py, radius=2]`.
                It must be a function of `rng` and its parameters alone.
    channels:   names, or `Channel`s with what is known exactly; default one, called `value`
    image:      shape of the picture
    averages:   whether an observation is the mean of independent primaries; default True of
                `estimate(rng)`, False of `estimate(rng, primaries)`
    bias:       unbiased, primaries, bootstrap, start-up or reconstruction; default unknown
    rays:       whether `estimate` counts its rays in `rng.rays`
    samplers:   sources of points that claims can be about
    arguments:  the suite's parameters; default `sys.argv[1:]`
    output:     descriptor of the replies; what is printed goes to standard error

    An exception of `estimate` ends the program with status 1. Its last line, with the place, ends
    standard error, and Assay's message.
    """
    given = Declaration(channels, image, averages, bias, rays, samplers)
    declared = given if given != Declaration() else declaration_of(estimate)
    words = sys.argv[1:] if arguments is None else arguments
    run(lambda: (estimate, declared, words), output)


def run(prepare: Callable[[], tuple[Callable[..., typing.Any], Declaration, Sequence[str]]],
        output: int = 1) -> None:
    """Serves what `prepare` returns. Its exception refuses: Assay ends with exit code 2."""
    questions, replies = _pipes(output)
    try:
        answers = _Answers(*prepare())
    except Exception as error:
        replies.write(f"assay 1 binary\nerror {last_line(error)}\n".encode())
        replies.flush()
        sys.exit(1)
    replies.write(answers.hello().encode())
    replies.flush()
    try:
        while len(question := questions.read(32)) == 32:
            answers.answer(struct.unpack("<4Q", question), questions, replies)
            replies.write(question)
            replies.flush()
    except BrokenPipeError:
        os._exit(1)  # nobody listens
    except (Exception, SystemExit) as error:
        print(last_line(error), file=sys.stderr, flush=True)
        sys.exit(1)


def last_line(error: BaseException) -> str:
    """ZeroDivisionError: division by zero, at mine.py:12 in estimate."""
    text = " ".join(traceback.format_exception_only(type(error), error)[-1].split())
    here = os.path.dirname(os.path.abspath(__file__))
    frames = [frame for frame in traceback.extract_tb(error.__traceback__)
              if os.path.dirname(os.path.abspath(frame.filename)) != here]
    if not frames:
        return text
    return f"{text}, at {os.path.basename(frames[-1].filename)}:{frames[-1].lineno} in {frames[-1].name}"


def _pipes(output: int) -> tuple[typing.BinaryIO, typing.BinaryIO]:
    """Questions and replies. What an estimator prints goes to standard error, and it reads nothing."""
    if os.isatty(0):
        print(f"{sys.argv[0]} answers questions of Assay, as in\n  assay check 'mean(mine) == 1' --estimator "
              f"'mine=process,command=[python3, {sys.argv[0]}]'", file=sys.stderr)
    questions, replies = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(output), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return questions, replies


class _Answers:
    """An estimator that answers questions."""

    def __init__(self, estimate: Callable[..., typing.Any], declared: Declaration, words: Sequence[str]):
        self._declared = declared
        self._whole = takes_primaries(estimate)
        self._averages = not self._whole if declared.averages is None else declared.averages
        parameters = parameters_of(estimate, words)
        self._estimate = (lambda *given: estimate(*given, **parameters)) if parameters else estimate
        self._channels = len(declared.all_channels())
        self._is_number = declared.image is None and self._channels == 1
        self._stream = Stream()

    def hello(self) -> str:
        return self._declared.hello(self._averages)

    def answer(self, question: tuple[int, ...], questions: typing.BinaryIO, replies: typing.BinaryIO) -> None:
        first_word, second, count, primaries = question
        if primaries == 0:
            self._ask_sampler(self._declared.samplers[first_word], second % 4, count, questions, replies)
            return
        for index in range(second, second + count):
            self._stream.begin(first_word, index)
            replies.write(self._observation(primaries))
            if self._declared.rays:
                replies.write(struct.pack("<d", self._stream.rays))

    def _observation(self, primaries: int) -> bytes:
        stream, estimate = self._stream, self._estimate
        if self._whole:
            value = estimate(stream, primaries)
            return _number(value) if self._is_number else _bytes(self._flat(value))
        if self._is_number:
            values = [estimate(stream) for _ in range(primaries)]
            try:
                total = math.fsum(values)
            except TypeError:
                for value in values:
                    _number(value)
                raise
            return struct.pack("<d", total / primaries)
        total = self._flat(estimate(stream)).copy()  # the estimate may use its array again
        for _ in range(primaries - 1):
            total = _sum(total, self._flat(estimate(stream)))
        return _bytes(total / primaries if _is_array(total) else [each / primaries for each in total])

    def _flat(self, value: typing.Any) -> typing.Any:
        """The numbers of an observation in their order: a list, or an array of numpy."""
        image = self._declared.image
        if image is None:
            return _numbers(value, (self._channels,))
        if self._channels == 0:
            return _numbers(value, image.shape)
        picture, *others = value
        numbers = _numbers(picture, image.shape)
        others = _numbers(others, (self._channels,))
        if not _is_array(numbers):
            return numbers + others
        import numpy

        return numpy.concatenate((numbers, others))

    def _ask_sampler(self, sampler: Sampler, what: int, count: int, questions: typing.BinaryIO,
                     replies: typing.BinaryIO) -> None:
        form = "<2Q" if what == 0 else "<3d"
        items = questions.read(count * struct.calcsize(form))
        for item in struct.iter_unpack(form, items):
            if what == 0:
                self._stream.begin(*item)
                replies.write(struct.pack("<6d", *_draw(sampler, self._stream)))
                continue
            point = item[0] if sampler.dimensions == 1 else item[:sampler.dimensions]
            of = sampler.density if what == 1 or sampler.evaluate is None else sampler.evaluate
            replies.write(struct.pack("<d", of(point)))


def _draw(sampler: Sampler, stream: Stream) -> tuple[float, ...]:
    drawn = sampler.draw(stream)
    if drawn is None:
        return (0.0,) * 6
    wanted = "(point, density)" if sampler.evaluate is None else "(point, density, weight)"
    try:
        point, density, *weight = drawn
        coordinates = (point,) if sampler.dimensions == 1 else tuple(point)
        weight = [1.0] if sampler.evaluate is None else weight
        (_,) = weight
    except (TypeError, ValueError):
        raise TypeError(f"draw() of `{sampler.name}` must return {wanted}, not {reprlib.repr(drawn)}") from None
    if len(coordinates) != sampler.dimensions:
        raise ValueError(f"a point of `{sampler.name}` has {sampler.dimensions} coordinates, not {len(coordinates)}")
    return (*coordinates, *(0.0,) * (3 - len(coordinates)), density, weight[0], 1.0)


def _is_array(value: typing.Any) -> bool:
    return hasattr(value, "__array__")


def _wrong(value: typing.Any, size: int) -> TypeError:
    """The error for a value that is not so many numbers."""
    if value is None:
        return TypeError("the estimate is None: does the function end with `return`?")
    if isinstance(value, str):
        return TypeError(f"the estimate is the text {reprlib.repr(value)}: return a number")
    return TypeError(f"the estimate is {reprlib.repr(value)}, not {size} number{'s' if size > 1 else ''}: "
                     "name the channels, or the image")


def _number(value: typing.Any) -> bytes:
    try:
        return struct.pack("<d", value)
    except (struct.error, TypeError):
        raise _wrong(value, 1) from None


def _numbers(value: typing.Any, shape: tuple[int, ...]) -> typing.Any:
    """The numbers of nested sequences or of an array. They have this shape, or are in one row."""
    size = math.prod(shape)
    if _is_array(value):
        import numpy

        array = numpy.asarray(value, dtype=numpy.float64)
        if array.shape not in (shape, (*shape, 1), (size,)):
            raise ValueError(f"the estimate has the shape {array.shape}, not {shape}")
        return array.ravel()
    if not isinstance(value, (list, tuple)):
        raise _wrong(value, size)
    if len(value) == size and not isinstance(value[0], (list, tuple)):
        return [float(each) for each in value]
    numbers: list[float] = []
    _flatten(value, shape, numbers)
    return numbers


def _flatten(value: typing.Any, shape: tuple[int, ...], into: list[float]) -> None:
    if not shape:
        into.append(float(value))
        return
    if len(value) != shape[0]:
        raise ValueError(f"the estimate has {len(value)} numbers or rows where {shape[0]} are declared")
    for each in value:
        _flatten(each, shape[1:], into)


def _sum(a: typing.Any, b: typing.Any) -> typing.Any:
    return a + b if _is_array(a) else [x + y for x, y in zip(a, b)]


def _bytes(numbers: typing.Any) -> bytes:
    if _is_array(numbers):
        return numbers.astype("<f8", copy=False).tobytes()
    return struct.pack(f"<{len(numbers)}d", *numbers)
