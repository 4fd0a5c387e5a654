"""Claims about functions, and the suite of all claims of a module."""

from __future__ import annotations

import json
import os
import re
import shlex
import sys
import types
import typing
from dataclasses import dataclass
from pathlib import Path

from assay.declaration import Function, declaration_of

_SOURCE = re.compile(r"(?<=[(,])(\s*)([^\W\d]\w*)\s*(?=[.,)])")  # the names in `quantity(name, other)`


@dataclass(frozen=True)
class Claim:
    """A sentence about a function, `it`, with the keys of its test in the suite."""

    text: str
    keys: dict[str, typing.Any]

    def __str__(self) -> str:
        return f"@assay.claim({', '.join([repr(self.text), *(f'{key}={value!r}' for key, value in self.keys.items())])})"


def claim(text: str, **keys: typing.Any) -> typing.Callable[[Function], Function]:
    """Makes a claim about the decorated function, which the claim calls `it`.

    Other functions of the module have their own names: `@claim("variance(it) < variance(plain)")`.
    The keys are those of a test in a suite: detect="1%", allow, weight, expect, …
    """
    if not isinstance(text, str):
        raise TypeError('a claim is a text, as in @assay.claim("mean(it) == 0.25")')

    def add(function: Function) -> Function:
        # The decorator that stands first is applied last.
        claims = [Claim(text, keys), *claims_of(function)]
        function.__assay_claims__ = claims  # type: ignore[attr-defined]
        return function

    return add


def claims_of(value: typing.Any) -> list[Claim]:
    """Those of a function; [] of anything else."""
    claims = getattr(value, "__assay_claims__", [])
    return claims if isinstance(claims, list) else []


def tests_of(module: types.ModuleType) -> list[tuple[str, str, Claim]]:
    """The module's claims in their order: function, name of the test, claim."""
    return [(function, f"{function}[{each.keys.get('name', each.text)}]", each)
            for function, value in vars(module).items() for each in claims_of(value)]


def write_suite(module: types.ModuleType, file: Path, names: typing.Container[str] | None = None) -> None:
    """Writes the suite of a module's claims, or of those of these names, and a script beside it that serves its functions.

    The suite names no folder: its numbers are the same wherever the module is.
    """
    estimators: dict[str, dict[str, typing.Any]] = {}
    tests = []
    for function, name, each in tests_of(module):
        if names is not None and name not in names:
            continue
        text = _SOURCE.sub(lambda found: found[1] + (function if found[2] == "it" else found[2]), each.text)
        tests.append({**each.keys, "name": name, "claim": text})
        named = [name for _, name in _SOURCE.findall(text)]
        for source in [*named, str(each.keys.get("reference"))]:
            value = getattr(module, source, None)
            if callable(value) or source in named:  # a name without a function is an error of its claims alone
                estimators[source] = {"plugin": "process", "command": ["sh", f"{file.stem}.sh", source],
                                      **(declaration_of(value).suite if callable(value) else {})}
    lines = [f"suite: {json.dumps(file.stem)}", "estimators:",
             *(f"  {source}: {json.dumps(entry)}" for source, entry in estimators.items()),
             "tests:", *(f"  - {json.dumps(test, ensure_ascii=False)}" for test in tests)]
    _write(file, "\n".join(lines) + "\n")
    path = os.pathsep.join(os.path.abspath(folder) for folder in sys.path)
    command = [sys.executable, "-m", "assay", os.path.abspath(str(module.__file__)), module.__name__]
    _write(file.with_suffix(".sh"), f"# Serves the functions of {file.stem}.py; the plugin of pytest wrote this.\n"
           f"cd {shlex.quote(os.getcwd())} || exit\n"
           f"export PYTHONPATH={shlex.quote(path)}\n"
           f'exec {shlex.join(command)} "$1"\n')


def _write(file: Path, text: str) -> None:
    """Whole or not at all: another run may read it."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f".{os.getpid()}-{file.name}")
    part.write_text(text, encoding="utf-8")
    part.replace(file)
