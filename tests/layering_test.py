#!/usr/bin/env python3
"""Holds the sources to the layers: layering_test.py SOURCE_FOLDER

Wrong includes between layers, renderer libraries outside estimators/render, words of other layers
in stats. It first shows that it can fail.
"""
import pathlib
import re
import sys

LAYERS = ("stats", "estimators", "harness", "reports")
MAY_INCLUDE = {
    "stats": {"stats"},
    "estimators": {"estimators"},
    "reports": {"reports"},
    "harness": set(LAYERS),
}
# How a layer's own folders are named in its includes (private include folder).
FOLDERS_OF_ESTIMATORS = ("analytic", "brdf", "environment", "foreign", "luminaire", "mutants",
                         "recorded", "render")
RENDERER = re.compile(r"embree|OpenEXR|Imf|Imath|Iex", re.IGNORECASE)
FOREIGN_TO_STATS = re.compile(r"(?<![a-z])(estimator|pixel|suite|file)s?(?![a-z])", re.IGNORECASE)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def code_only(text):
    """The text without comments and string literals."""
    pattern = r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"'
    return re.sub(pattern, " ", text, flags=re.DOTALL)


def wrong_include(path, include):
    """Why a source may not include this, or None."""
    layer = path.parts[0]
    target = include.split("/")[0]
    if target in LAYERS and target not in MAY_INCLUDE[layer]:
        return f"{layer} includes {include}"
    if layer != "estimators" and target in FOLDERS_OF_ESTIMATORS:
        return f"{layer} includes {include}, which is private to estimators"
    if layer == "harness" and re.match(r"estimators/(" + "|".join(FOLDERS_OF_ESTIMATORS) + ")/",
                                       include):
        return f"harness includes {include}; a plugin is reached through the catalogue"
    if RENDERER.search(include) and path.parts[:2] != ("estimators", "render"):
        return f"{include} is included outside estimators/render"
    if layer == "stats" and path.suffix == ".h" and include.startswith("boost/"):
        return f"a header of stats includes {include}"
    if layer == "stats" and "/" in include and not include.startswith(("stats/", "boost/")):
        return f"stats includes {include}"
    return None


def faults(path, text):
    """What is wrong with a source of this path (relative to the root)."""
    found = [wrong_include(path, include) for include in INCLUDE.findall(text)]
    if path.parts[0] == "stats":
        found += [f"the word `{match.group()}` in stats"
                  for match in FOREIGN_TO_STATS.finditer(code_only(text))]
    return [fault for fault in found if fault]


def show_that_it_can_fail():
    wrong = [
        ("stats/a.h", '#include "harness/run.h"\n'),
        ("stats/a.h", "#include <boost/math/distributions.hpp>\n"),
        ("stats/a.cpp", "#include <tbb/tbb.h>\n"),
        ("stats/a.cpp", "double pixel_mean;\n"),
        ("estimators/a.cpp", '#include "stats/moments.h"\n'),
        ("estimators/luminaire/a.cpp", "#include <embree3/rtcore.h>\n"),
        ("reports/a.cpp", '#include "harness/run.h"\n'),
        ("reports/a.cpp", '#include "estimators/cost.h"\n'),
        ("harness/a.cpp", '#include "estimators/luminaire/area.h"\n'),
        ("harness/a.cpp", "#include <ImfRgbaFile.h>\n"),
    ]
    right = [
        ("stats/a.cpp", "#include <boost/math/distributions.hpp>\n// of a profile, a file\n"),
        ("estimators/render/a.cpp", "#include <embree3/rtcore.h>\n"),
        ("harness/a.cpp", '#include "stats/moments.h"\n#include "reports/record.h"\n'),
    ]
    for path, text in wrong:
        assert faults(pathlib.Path(path), text), f"not noticed: {text} in {path}"
    for path, text in right:
        assert not faults(pathlib.Path(path), text), f"wrongly refused: {text} in {path}"


def main():
    show_that_it_can_fail()
    root = pathlib.Path(sys.argv[1])
    sources = [path for layer in LAYERS for path in sorted((root / layer).rglob("*"))
               if path.suffix in (".h", ".cpp")]
    assert len(sources) > 100, f"only {len(sources)} sources below {root}"
    count = 0
    for path in sources:
        for fault in faults(path.relative_to(root), path.read_text(encoding="utf-8")):
            print(f"{path.relative_to(root)}: {fault}")
            count += 1
    print(f"{len(sources)} sources, {count} faults")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
