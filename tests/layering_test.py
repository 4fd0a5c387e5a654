#!/usr/bin/env python3
"""Holds the sources to the layers: layering_test.py SOURCE_FOLDER

Wrong includes between layers and folders, cycles of includes, folders that hold too many files,
questions for the kind of a claim or the name of a method outside their tables, renderer libraries outside estimators/render, words of other layers in stats. It first shows that it
can fail.
"""
import collections
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
# A folder includes only itself and those before it.
FOLDERS = {
    "stats": "basics tails planning gates means variances laws cells images pyramids",
    "reports": "record words formats viewer",
    "harness": "base language suite sampling draws ranks question theta image pilot plan run families record "
               "ledger calibration command googletest",
}
MOST_FILES = 40  # in one folder
LARGEST_CYCLE = 0.05  # of a layer's lines; a .h and its .cpp count as one
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


def points_up(path, include):
    """Why a source may not include this folder of its own layer, or None."""
    layer = path.parts[0]
    target = include.split("/")
    if layer not in FOLDERS or len(target) < 3 or target[0] != layer or len(path.parts) < 3:
        return None
    order = FOLDERS[layer].split()
    if target[1] not in order or path.parts[1] not in order:
        return f"the folder of {path} or {include} is not in the order of this test"
    if order.index(target[1]) > order.index(path.parts[1]):
        return f"{path.parts[1]} includes {include}, which comes after it"
    return None


METHOD_NAME = re.compile(r'method(?:\(\))?(?:\.name)? *[!=]= *"|method\.name *[!=]=')


def compared_names(path, text):
    """A method is asked for its properties. Only the table finds a row by its name."""
    if path.parts[0] != "harness" or path == pathlib.Path("harness/theta/methods.cpp"):
        return []
    return [f"`{match.group()}` compares the name of a method"
            for match in METHOD_NAME.finditer(text)]


QUANTITY = re.compile(r"theta *[!=]= *&|row->word *[!=]=|row *[!=]= *&|theta_of_\w+\(\)|"
                      r"dynamic_cast<const \w*Theta")


def asked_kinds(path, text):
    """A claim's theta is asked for what it does. Only its family knows what it is."""
    if path.parts[0] != "harness" or path.parts[1] == "families":
        return []
    return [f"`{match.group()}` asks for the kind of a claim; ask its Theta"
            for match in QUANTITY.finditer(text)]


def largest_cycle(texts):
    """The units of the largest cycle of includes and its part of all lines; texts by path."""
    lines, includes = collections.Counter(), collections.defaultdict(set)
    for path, text in texts.items():
        unit = str(path.with_suffix(""))
        lines[unit] += text.count("\n")
        includes[unit] |= {str(pathlib.Path(i).with_suffix("")) for i in INCLUDE.findall(text)}

    def reached(start):
        seen, waiting = set(), [start]
        while waiting:
            for unit in includes[waiting.pop()] & lines.keys() - seen:
                seen.add(unit)
                waiting.append(unit)
        return seen

    all_reached = {unit: reached(unit) for unit in lines}
    cycles = [{other for other in all_reached[unit] if unit in all_reached[other]} - {unit} | {unit}
              for unit in lines]
    cycles = [cycle for cycle in cycles if len(cycle) > 1]
    largest = max(cycles, key=lambda cycle: sum(lines[u] for u in cycle), default=set())
    return sorted(largest), sum(lines[u] for u in largest) / max(1, sum(lines.values()))


def crowded(paths):
    """Folders with more than MOST_FILES of these."""
    count = collections.Counter(path.parent for path in paths)
    return [f"{folder} holds {number} files, {MOST_FILES} at most"
            for folder, number in count.items() if number > MOST_FILES]


def faults(path, text):
    """What is wrong with a source of this path (relative to the root)."""
    found = [wrong_include(path, include) for include in INCLUDE.findall(text)]
    found += [points_up(path, include) for include in INCLUDE.findall(text)]
    found += compared_names(path, text)
    found += asked_kinds(path, text)
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
        ("harness/base/a.cpp", '#include "harness/plan/plan.h"\n'),
        ("harness/base/a.cpp", '#include "harness/elsewhere/plan.h"\n'),
        ("harness/plan/a.cpp", 'if (plan.method.name == "t") return;\n'),
        ("harness/plan/a.cpp", 'if (question.theta == &theta_of_means()) return;\n'),
        ("harness/run/a.cpp", 'if (claim.left.row->word == "mean") return;\n'),
    ]
    right = [
        ("stats/a.cpp", "#include <boost/math/distributions.hpp>\n// of a profile, a file\n"),
        ("estimators/render/a.cpp", "#include <embree3/rtcore.h>\n"),
        ("harness/a.cpp", '#include "stats/moments.h"\n#include "reports/record.h"\n'),
        ("harness/plan/a.cpp", '#include "harness/base/text_file.h"\n'),
    ]
    for path, text in wrong:
        assert faults(pathlib.Path(path), text), f"not noticed: {text} in {path}"
    for path, text in right:
        assert not faults(pathlib.Path(path), text), f"wrongly refused: {text} in {path}"
    ring = {pathlib.Path(f"{a}.h"): f'#include "{b}.h"\n' for a, b in ("ab", "bc", "ca", "da")}
    assert largest_cycle(ring) == (["a", "b", "c"], 0.75), largest_cycle(ring)
    assert crowded([pathlib.Path(f"a/{i}.h") for i in range(MOST_FILES + 1)])


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
    for layer in LAYERS:
        texts = {path.relative_to(root): path.read_text(encoding="utf-8") for path in sources
                 if path.relative_to(root).parts[0] == layer}
        units, part = largest_cycle(texts)
        print(f"{layer}: the largest cycle of includes has {part:.1%} of its lines")
        if part > LARGEST_CYCLE:
            print(f"{layer}: too large a cycle: {' '.join(units)}")
            count += 1
    for fault in crowded([path.relative_to(root) for path in sources]):
        print(fault)
        count += 1
    print(f"{len(sources)} sources, {count} faults")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
