"""Serves one function of a file: python3 -m assay FILE MODULE FUNCTION."""

from __future__ import annotations

import difflib
import importlib.util
import sys
import typing

from assay.declaration import Declaration, declaration_of
from assay.protocol import run


def _prepare() -> tuple[typing.Callable[..., typing.Any], Declaration, list[str]]:
    file, module_name, function_name = sys.argv[1:]
    specification = importlib.util.spec_from_file_location(module_name, file)
    if specification is None or specification.loader is None:
        raise ImportError(f"{file} is no file of Python")
    module = importlib.util.module_from_spec(specification)
    sys.modules[module_name] = module
    specification.loader.exec_module(module)

    functions = [name for name, value in vars(module).items() if callable(value)]

    def missing(rng: typing.Any) -> float:  # an error of its own claims, not of the module's
        near = difflib.get_close_matches(function_name, ["it", *functions], 1)
        raise LookupError(f"{module_name} has no function `{function_name}`"
                          + "".join(f"; did you mean `{name}`?" for name in near))

    function = getattr(module, function_name, missing)
    return function, declaration_of(function), []


if __name__ == "__main__":
    run(_prepare)
