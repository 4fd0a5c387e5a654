#!/usr/bin/env python3
"""A matrix of deaths: one thing that dies takes nothing with it.

    deaths_test.py ASSAY SOURCE_FOLDER [PART…] [--kills N] [--list] [--only TEXT] [--keep FOLDER]

Each cell is a kind of source, a way to die and a phase in which it dies. The cells are made of the
three lists below and the predicate exists(). A cell is a suite in a folder of its own; its source
is deaths.c, which reads in that folder how and when to die. Many suites make one run. Expected is
what the same suite gives where nobody dies: the tests that needed the dead source are errors that
say why, all others have the verdict and the numbers that they have without it. Where a run itself
breaks, its cells are run again in halves, so that each failing cell is one line: kind, way, phase,
what was expected, what was seen.
"""
import argparse
import concurrent.futures
import dataclasses
import fcntl
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import xml.etree.ElementTree

import jsonschema

# ---- The three lists ---------------------------------------------------------------------------

# A test's observations are means of so many primaries, a pilot's of one: so phases are told apart.
PRIMARIES = 16
TIMEOUT = 1.5  # Seconds that a hanging source gets. A sound one starts in less.
PICTURE_TIMEOUT = 0.05  # Seconds that a renderer of several gets for each picture.
PATIENCE = 100  # Seconds that a run of Assay may take, whatever its sources do.

# A message must match the pattern of its way, and name the estimator and the observation. A source
# says "no light" on its standard error or in the message of its library.
WAYS = {
    "exit0": r"exit status 0.*no light",
    "exit3": r"exit status 3.*no light",
    "kill": r"signal 9.*no light",
    "segv": r"signal 11.*no light",
    "abort": r"signal 6.*no light",
    "hang": r"(within|more than) [\d.]+ s.*no light",
    "stop": r"(within|more than) [\d.]+ s.*no light",
    # A library's host ends with 3 a second after it lost its pipes.
    "close": r"(closed its standard output|exit status 3).*no light",
    "orphan": r"exit status 0.*no light|(within|more than) [\d.]+ s.*no light|wrote no file",
    "chatter": r"exit status 3.*no light",
    "flood": r"cannot be understood",
    "deaf": r"no light|closed its standard input",
    "short": r"lacks|the line `ready`|unusable|cannot be read",
    "long": r"should be a line of 1 number|not end with the question|unusable",
    "garbage": r"cannot be understood|unusable|not a number",
    "nan": r"not finite|nan",
    "inf": r"not finite",
    "beyond": r"above 1|outside|must have length 1",
    "error": r"no light.*status 4|status 4 of sample",
    "print": r"printed `lamp on",
    "refuse": r"no light",
    "nofile": r"wrote no file",
    "empty": r"unusable|no rows",
}
WAITING = {"hang", "stop", "orphan", "deaf"}  # may take a time-out each
ANSWERS = {"nan", "inf", "beyond"}    # are observations, that no hello has

PHASES = ["hello", "restart", "pilot", "first", "later", "last",
          "plan hello", "plan pilot",
          "replay hello", "replay first", "replay last", "replay one"]
SAMPLER_PHASES = ["density", "evaluate", "first", "last", "plan density", "replay first"]

NUMBER_TESTS = """\
  - {{name: mean, claim: mean({name}) == 0.5005, detect: 0.004}}
  - {{name: variance, claim: variance({name}) == 0.0833333333, detect: 30%}}
  - {{name: quantile, claim: "quantile({name}, 0.5) <= 4"}}
  - {{name: efficiency, claim: efficiency({name}) > 0.001, cost: samples}}
  - {{name: total, claim: total_variance({name}) <= 9}}
  - {{name: law, claim: distribution({name}) == distribution(sound), expect: fail}}
  - {{name: bias, claim: bias({name}) == 0, reference: 0.5}}
  - {{name: within, claim: mean({name}) within 5% of 0.5}}
  - {{name: compared, claim: mean(sound) <= mean({name})}}
"""
IMAGE_TESTS = """\
  - {{name: mean, claim: mean({name}) == 0.5005, detect: 0.004}}
  - {{name: one, claim: mean({name}) == 0.5, secondaries: 70}}
"""
PICTURE_TESTS = """\
  - {{name: mean, claim: mean({name}) == 0.5, secondaries: 40}}
  - {{name: average, claim: mean({name}.average) == 0.5, secondaries: 48}}
"""
ROW_TESTS = """\
  - {{name: mean, claim: mean({name}) == 0.5, secondaries: 100}}
  - {{name: compared, claim: mean(sound) <= mean({name}), secondaries: 120}}
"""
SAMPLER_TESTS = """\
  - {{name: cells, claim: distribution({name}.cosine) == density, secondaries: 3000}}
  - {{name: theta, claim: distribution({name}.cosine.theta) == density, secondaries: 3000}}
  - {{name: integral, claim: integral({name}.cosine) == 1}}
  - {{name: inconsistency, claim: inconsistency({name}.cosine) == 0}}
  - {{name: flat, claim: distribution({name}.flat) == density}}
"""

ENDINGS = ["exit0", "exit3", "kill", "segv", "abort", "hang", "close"]


@dataclasses.dataclass(frozen=True)
class Kind:
    source: str
    tests: str
    ways: list
    phases: list = dataclasses.field(default_factory=lambda: PHASES)
    primaries: int = PRIMARIES

    @property
    def is_renderer(self):
        return "plugin: command" in self.source

    @property
    def is_library(self):
        return "plugin: library" in self.source

    @property
    def has_samplers(self):
        return self.phases is SAMPLER_PHASES


PROGRAM_WAYS = ENDINGS + ["stop", "orphan", "chatter", "flood", "deaf", "short", "long", "garbage",
                          "nan", "inf", "beyond", "refuse"]
RENDERER_WAYS = ["exit3", "kill", "segv", "hang", "orphan", "garbage", "nan", "long", "nofile",
                 "empty"]
KINDS = {
    "text": Kind("plugin: process, command: [../deaths, text]", NUMBER_TESTS, PROGRAM_WAYS),
    "binary": Kind("plugin: process, command: [../deaths, binary]", NUMBER_TESTS, PROGRAM_WAYS),
    "image": Kind("plugin: process, command: [../deaths, image]", IMAGE_TESTS, PROGRAM_WAYS),
    "isolated": Kind("plugin: library, file: ../deaths.so", NUMBER_TESTS,
                     ENDINGS + ["orphan", "chatter", "error", "print", "nan", "inf", "beyond"]),
    "inside": Kind("plugin: library, file: ../deaths.so, isolated: false", NUMBER_TESTS,
                   ["error", "nan", "inf", "beyond"]),
    "row": Kind('plugin: command, command: [../deaths, row, "{{seed}}", "{{samples}}", "{{out}}"], '
                "output: text", ROW_TESTS, RENDERER_WAYS, primaries=4),
    "picture": Kind('plugin: command, command: [../deaths, picture, "{{seeds}}", "{{samples}}", '
                    '"{{out}}", several]', PICTURE_TESTS, RENDERER_WAYS + ["short"], primaries=4),
    "sampler isolated": Kind("plugin: library, file: ../deaths.so", SAMPLER_TESTS,
                             ENDINGS + ["error", "print", "nan", "beyond"], SAMPLER_PHASES),
    "sampler inside": Kind("plugin: library, file: ../deaths.so, isolated: false", SAMPLER_TESTS,
                           ["error", "nan", "beyond"], SAMPLER_PHASES),
}


@dataclasses.dataclass(frozen=True)
class Cell:
    kind: str
    way: str
    phase: str

    @property
    def name(self):
        return f"{self.kind}_{self.way}_{self.phase}".replace(" ", "_")

    @property
    def command(self):
        word = self.phase.split()[0]
        return word if word in ("plan", "replay") else "run"

    @property
    def moment(self):
        """The phase, whatever the command."""
        return self.phase.split()[-1]

    def __str__(self):
        return f"{self.kind}, {self.way}, {self.phase}"


def exists(cell):
    """Whether a source of this kind can die this way in this phase, and tells more than others."""
    kind, way, moment = KINDS[cell.kind], cell.way, cell.moment
    if moment == "evaluate" and way == "error" or moment == "density" and way in ("error", "beyond"):
        return False  # they return a number; a density below zero is `invalid`
    if moment == "evaluate" and way == "beyond":
        return False
    if kind.has_samplers:
        return True
    if way in ANSWERS and moment in ("hello", "restart"):
        return False
    if way == "long" and moment in ("hello", "restart"):
        return False
    if way in ("refuse", "deaf") and moment != "hello":
        return False
    if kind.is_library and moment == "hello" and way == "print":
        return False
    if cell.kind == "inside" and moment == "restart":
        return False
    if way == "error" and moment == "restart":
        return False
    if kind.is_renderer:
        if moment in ("restart", "later"):
            return False  # its pictures are its programs; one look
        if cell.kind == "row":  # a program a picture: hundreds of them a cell
            return cell.command == "run" and way in ("exit3", "hang", "nan", "long", "nofile")
        if cell.command == "replay" and moment == "hello" and way != "exit3":
            return False
        if way in WAITING:
            return cell.phase in ("hello", "first") and (way, moment) != ("orphan", "hello")
        return True
    if cell.command == "replay" and moment in ("hello", "last"):
        return way in ("exit3", "hang", "kill", "nan", "error") and exists(Cell(cell.kind, way, moment))
    if way in ("stop", "orphan", "flood", "chatter"):
        return cell.phase in ("hello", "first", "last")
    return True


# Every way and every phase come in the short form too, though not each in each.
EVERY = 1 if "ASSAY_LONG" in os.environ else 3


def all_cells():
    return [cell for kind in KINDS
            for i, phase in enumerate(KINDS[kind].phases) for k, way in enumerate(KINDS[kind].ways)
            if (i + k) % EVERY == 0 and exists(cell := Cell(kind, way, phase))]


# ---- Running Assay ------------------------------------------------------------------------------

class Failure(Exception):
    """What was expected, what was seen."""

    def __init__(self, expected, seen):
        super().__init__(f"expected {expected}; seen {seen}")


def short(text, most=300):
    text = " ".join(str(text).split())
    return text if len(text) <= most else text[: most - 1] + "…"


def expect(condition, expected, seen):
    if not condition:
        raise Failure(expected, short(seen))


@dataclasses.dataclass
class Ended:
    code: int
    out: str
    err: str
    seconds: float


def end_of(process, start):
    """How a run of Assay ended, which it does in time and without a crash."""
    try:
        out, err = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise Failure(f"an end within {PATIENCE} s", "Assay hangs") from None
    ended = Ended(process.returncode, out.decode(errors="replace"),
                  err.decode(errors="replace"), time.monotonic() - start)
    require_no_crash(ended)
    return ended


class Bench:
    """The binary under test, a folder to work in, what was found."""

    def __init__(self, assay, source, work):
        self.assay = assay
        self.work = work
        self.environment = dict(os.environ, NO_COLOR="1", XDG_CACHE_HOME=str(work))
        for name in ("FORCE_COLOR", "CLICOLOR_FORCE", "GITHUB_ACTIONS", "GTEST_TOTAL_SHARDS",
                     "GTEST_SHARD_INDEX", "TEST_TOTAL_SHARDS", "TEST_SHARD_INDEX"):
            self.environment.pop(name, None)
        # A library's crash in its host ends as it does without the sanitizer.
        sanitizer = "handle_segv=0:handle_abort=0:detect_leaks=0:allocator_may_return_null=1"
        given = os.environ.get("ASAN_OPTIONS")
        self.environment["ASAN_OPTIONS"] = sanitizer + (":" + given if given else "")
        schema = json.loads((source / "reports/record/record.schema.json").read_text())
        self.schema = jsonschema.Draft202012Validator(schema)
        self.failures = []
        self.cells = 0
        self.lock = threading.Lock()
        include = source / "estimators"
        code = source / "tests/cli/deaths.c"
        # Started thousands of times: without libraries to load it takes half the time.
        for more in (["-static", "-o", "deaths"], ["-fPIC", "-shared", "-o", "deaths.so"]):
            subprocess.run(["cc", "-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                            "-I", include, code, *more, "-lm"], cwd=work, check=True)

    def run(self, *arguments, **more):
        start = time.monotonic()
        process = subprocess.Popen([self.assay, *map(str, arguments)], cwd=self.work,
                                   env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more)
        return end_of(process, start)

    def note(self, what, failure):
        with self.lock:
            line = f"{what}: {failure}"
            self.failures.append(line)
            print("FAILED", line, flush=True)


def require_no_crash(ended):
    if ended.code < 0:
        raise Failure("no crash", f"signal {-ended.code} ({signal.Signals(-ended.code).name})")
    for bad in ("internal error", "terminate called", "AddressSanitizer", "runtime error:",
                "Assertion"):
        expect(bad not in ended.err, "no crash", ended.err)


REPORTS = {"json": "run.json", "html": "run.html", "junit": "run.xml", "markdown": "run.md",
           "metrics": "run.txt", "console": "run.console"}


def report_arguments(folder, kinds=REPORTS):
    return [word for kind in kinds for word in ("--report", f"{kind}={folder}/{REPORTS[kind]}")]


def require_reports(bench, folder, suites, kinds=REPORTS):
    """Every report is there and whole; the record."""
    for kind in kinds:
        expect((folder / REPORTS[kind]).exists(), f"a report of kind {kind}", "none")
    record = None
    if "json" in kinds:
        try:
            record = json.loads((folder / "run.json").read_text())
        except ValueError as error:
            raise Failure("json that parses", error) from None
        error = next(bench.schema.iter_errors(record), None)
        expect(error is None, "a record that validates",
               error and f"{error.json_path}: {error.message}")
        expect(len(record["suites"]) == suites, f"{suites} suites in the record",
               len(record["suites"]))
    tests = sum(len(suite["tests"]) for suite in record["suites"]) if record else 0
    if "junit" in kinds:
        try:
            root = xml.etree.ElementTree.parse(folder / "run.xml").getroot()
        except xml.etree.ElementTree.ParseError as error:
            raise Failure("junit that parses", error) from None
        count = len(list(root.iter("testcase")))
        expect(not record or count >= tests, f"{tests} tests in junit", count)
    if "html" in kinds:
        html = (folder / "run.html").read_text()
        expect(html.rstrip().endswith("</html>"), "html that ends with </html>", html[-80:])
        expect("<b>&]]>" not in html, "html whose messages are escaped", "they are not")
    if "metrics" in kinds:
        text = (folder / "run.txt").read_text()
        expect(text.endswith("# EOF\n"), "metrics that end with # EOF", text[-80:])
    if "console" in kinds:
        text = (folder / "run.console").read_text()
        expect(re.search(r"^[✓✗?–] .*(claim|None of)[^✓✗?–]*\Z", text, re.MULTILINE),
               "a console report with its verdict", text[-80:])
    if "markdown" in kinds:
        expect((folder / "run.md").read_text().strip(), "a markdown report", "an empty one")
    return record


# ---- Suites of cells ----------------------------------------------------------------------------

def timeout_of(kind):
    return PICTURE_TIMEOUT if kind == "picture" else TIMEOUT


def suite_text(kind, name, waiting):
    timeout = timeout_of(kind) if waiting else 60
    source = KINDS[kind].source.replace("{{", "{").replace("}}", "}")
    primaries = "" if KINDS[kind].has_samplers else (
        f", primaries: {KINDS[kind].primaries}")
    timeout = f", timeout: {timeout}" if "isolated: false" not in source else ""
    return (f"suite: {name}\nestimators:\n"
            f"  {name}: {{{source}{primaries}{timeout}}}\n"
            "  sound: {plugin: analytic/normal}\n"
            "tests:\n" + KINDS[kind].tests.format(name=name) +
            "  - {name: sound, claim: mean(sound) == 0}\n")


def write_suite(bench, kind, name, waiting=False):
    folder = bench.work / name
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.yaml").write_text(suite_text(kind, name, waiting))
    return f"{name}/{name}.yaml"


@dataclasses.dataclass
class Live:
    """What a suite gives where nobody dies."""
    name: str
    tests: dict
    record: str

    def samples(self, test, name=None):
        return [s for s in self.tests[test]["samples"] if s["estimator"] == (name or self.name)]

    def drawn(self, test):
        return max((s["secondaries"] for s in self.samples(test)), default=0)


def live_run(bench, kind):
    name = f"live_{kind}".replace(" ", "_")
    suite = write_suite(bench, kind, name)
    folder = bench.work / name
    ended = bench.run("run", suite, *report_arguments(folder))
    expect(ended.code == 0, "exit code 0 of a suite in which nobody dies",
           f"{ended.code}: {ended.err}{ended.out}")
    record = require_reports(bench, folder, 1)
    live = Live(name, {t["name"]: t for t in record["suites"][0]["tests"]},
                f"{name}/run.json")
    if "mean" in live.tests and not KINDS[kind].is_renderer:
        expect(len(live.tests["mean"]["looks"]) > 1, "several looks of `mean`", "one")
    return live


MAPPED = "cells"  # the test of a sampler whose draws die


def order_of(cell, live):
    """The line of the file `order`, and the observation that dies."""
    kind = KINDS[cell.kind]
    moment = cell.moment
    if moment in ("hello", "restart", "density", "evaluate"):
        return f"{cell.way} {moment} {kind.primaries} 0 0", None
    test = MAPPED if kind.has_samplers else "mean"
    sample = live.samples(test)[0]
    key = int(sample["stream"], 16)
    if moment == "later":
        index = live.tests["mean"]["looks"][0]["secondaries"] + 7
    elif moment == "last":
        index = live.drawn(longest(live)) - 1 if not kind.has_samplers else (
            live.drawn(test) - 1)
    else:
        index = 3
    if kind.has_samplers:
        return f"{cell.way} draw 1 {index} {key}", index
    if moment == "pilot":
        if kind.is_renderer:
            return f"{cell.way} pilot {kind.primaries} 0 {key}", None
        return f"{cell.way} at 1 5 0", 5
    return f"{cell.way} at {kind.primaries} {index} {key}", index


def longest(live):
    return max(live.tests, key=live.drawn)


def needs(cell, live, test, index):
    """Whether the test needs what the source does not give."""
    samples = live.samples(test)
    if test == "integral" and cell.moment == "density":
        return True
    if not samples:
        return False
    kind = KINDS[cell.kind]
    if kind.has_samplers:
        if test == "flat":
            return False
        if cell.moment == "density":
            return True
        if cell.moment == "evaluate":
            return test == "inconsistency"
        stream = live.samples(MAPPED)[0]["stream"]
        return any(s["stream"] == stream and s["secondaries"] > index for s in samples)
    if cell.moment in ("hello", "restart", "pilot"):
        return True
    if cell.kind == "picture" and cell.way in ENDINGS:
        return True  # what a program of several had made is whole or not: nobody knows
    return live.drawn(test) > index


def require_message(cell, message, index, name):
    expect(f"`{name}`" in message, f"a message that names `{name}`", message)
    expect(re.search(WAYS[cell.way], message, re.DOTALL), f"a message with /{WAYS[cell.way]}/",
           message)
    if cell.moment in ("hello", "restart", "density"):
        return
    if cell.way == "beyond" and not KINDS[cell.kind].has_samplers:
        return  # which of them it was is not kept
    # A renderer of several fails with its whole block, whose first observation is named.
    number = r"\d+" if index is None or cell.kind == "picture" else index
    expect(re.search(rf"observation {number}\b", message), f"a message with observation {number}",
           message)


def bare(value):
    """Without times, and without what Holm makes of the p-values of the suite's other tests."""
    if isinstance(value, dict):
        return {key: bare(part) for key, part in value.items()
                if key not in ("seconds", "where", "replay") and "adjusted" not in key}
    if isinstance(value, list):
        return [bare(part) for part in value]
    return value


def require_test(cell, live, test, index, name):
    known = live.tests[test["name"]]
    if needs(cell, live, test["name"], index):
        if cell.moment == "restart" and test["verdict"] == known["verdict"]:
            return  # it read nothing of the second program
        expect(test["verdict"] == "error", f"error of `{test['name']}`",
               f"{test['verdict']}: {test['message']}")
        require_message(cell, test["message"], index, name)
        return
    expect(test["verdict"] == known["verdict"], f"{known['verdict']} of `{test['name']}`",
           f"{test['verdict']}: {test['message']}")
    def numbers(samples):
        return [{key: part for key, part in bare(sample).items()
                 if key not in ("estimator", "parameters")} for sample in samples]

    expect(numbers(test["samples"]) == numbers(known["samples"]),
           f"the samples of `{test['name']}` as without the dead source", "others")
    if not live.samples(test["name"]):
        for part in ("channels", "looks"):
            expect(bare(test[part]) == bare(known[part]), f"the {part} of `{test['name']}` as "
                   "without the dead source", "others")


# ---- Runs of many cells -------------------------------------------------------------------------

def prepare(bench, cell, live):
    suite = write_suite(bench, cell.kind, cell.name, cell.way in WAITING)
    order, index = order_of(cell, live)
    folder = bench.work / cell.name
    (folder / "order").write_text(order + "\n")
    for trace in ("started", "restarted"):
        (folder / trace).unlink(missing_ok=True)
    shutil.rmtree(folder / ".assay-cache", ignore_errors=True)
    return suite, index


def is_refused(cell):
    """A program that refuses its parameters is a mistake of the suite."""
    return cell.moment == "hello" and cell.way in ("refuse", "error")


counter = iter(range(10**9))


def run_group(bench, cells, live):
    """All cells in one run of Assay. Throws where the run itself breaks; else (cell, failure)."""
    prepared = [prepare(bench, cell, live) for cell in cells]
    folder = bench.work / f"reports_{next(counter)}"
    folder.mkdir()
    ended = bench.run("run", *[suite for suite, _ in prepared], *report_arguments(folder))
    if any(is_refused(cell) for cell in cells):
        expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.out}")
        said = " ".join(ended.err.split())
        expect(re.search(WAYS[cells[0].way], said), "the source's words", said)
        return []
    expect(ended.code in (0, 1), "exit code 1", f"{ended.code}: {ended.err}")
    record = require_reports(bench, folder, len(cells))
    failures = []
    any_bad = False
    for cell, (_, index), suite in zip(cells, prepared, record["suites"]):
        try:
            names = [test["name"] for test in suite["tests"]]
            expect(names == list(live.tests), "all tests of the suite", names)
            for test in suite["tests"]:
                any_bad |= not test["ok"]
                require_test(cell, live, test, index, cell.name)
            if (bench.work / cell.name / "restarted").exists():
                verdicts = [test["verdict"] for test in suite["tests"]]
                expect("error" in verdicts, "an error, as a second program died", verdicts)
        except Failure as failure:
            failures.append((cell, failure))
    expect(ended.code == (1 if any_bad else 0), f"exit code {1 if any_bad else 0}", ended.code)
    shutil.rmtree(folder)
    return failures


def run_cells(bench, cells, live):
    try:
        failures = run_group(bench, cells, live)
    except Failure as failure:
        if len(cells) == 1:
            failures = [(cells[0], failure)]
        else:
            middle = len(cells) // 2
            run_cells(bench, cells[:middle], live)
            run_cells(bench, cells[middle:], live)
            return
    for cell, failure in failures:
        bench.note(cell, failure)


def plan_cell(bench, cell, live):
    suite, index = prepare(bench, cell, live)
    ended = bench.run("plan", suite)
    if is_refused(cell):
        expect(ended.code == 2, "exit code 2", ended.code)
        said = " ".join(ended.err.split())
        expect(re.search(WAYS[cell.way], said), "the source's words", said)
        return
    expect(ended.code in (0, 1), "exit code 1 or 0", f"{ended.code}: {ended.err}")
    for test in live.tests:
        expect(re.search(rf"^  {test}(, by .*)?$", ended.out, re.MULTILINE), f"a row of `{test}`", ended.out)
    require_message(cell, " ".join(ended.out.split()), index, cell.name)


def replay_cell(bench, cell, live_of):
    """Each replays the record of its own suite, made before it died."""
    live = live_of
    suite, index = prepare(bench, cell, live)
    folder = bench.work / cell.name
    # The record of the sound run, under this cell's names: the streams are the same.
    text = (bench.work / live.record).read_text().replace(live.name, cell.name)
    if cell.way in WAITING:
        text, count = re.subn(r'(timeout=\\?"?)60', rf"\g<1>{timeout_of(cell.kind)}", text)
        expect(count, "a time-out in the record", "none")
    (folder / "run.json").write_text(text)
    test = MAPPED if KINDS[cell.kind].has_samplers else (
        longest(live) if cell.moment == "last" else "mean")
    words = [f"{cell.name}/run.json", f"{cell.name}/{test}"]
    if cell.moment == "one":
        words.append(index)
    ended = bench.run("replay", *words)
    if is_refused(cell):
        expect(ended.code == 2, "exit code 2", ended.code)
    else:
        expect(ended.code == 1, "exit code 1", f"{ended.code}: {ended.err}")
    said = " ".join((ended.out + ended.err).split())
    if cell.way in ANSWERS and not KINDS[cell.kind].is_renderer:
        return expect(re.search(WAYS[cell.way] + r"|not finite|NOT (as|the numbers) recorded", said),
                      "that it is not as recorded", said)
    expect(re.search(WAYS[cell.way], said), f"/{WAYS[cell.way]}/", said)
    expect("the same numbers as recorded" not in said.replace("NOT the", ""), "no praise", said)


def alone(bench, cell, do, live):
    try:
        do(bench, cell, live)
    except Failure as failure:
        bench.note(cell, failure)


def part_matrix(bench, kind, only):
    cells = [cell for cell in all_cells() if cell.kind == kind and only in str(cell)]
    bench.cells += len(cells)
    if not cells:
        return
    try:
        live = live_run(bench, kind)
    except Failure as failure:
        return bench.note(f"{kind}, alive", failure)
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        jobs = []
        runs = [cell for cell in cells if cell.command == "run"]
        for phase in dict.fromkeys(cell.phase for cell in runs):
            group = [cell for cell in runs if cell.phase == phase]
            for cell in [cell for cell in group if is_refused(cell)]:
                jobs.append(pool.submit(run_cells, bench, [cell], live))
            group = [cell for cell in group if not is_refused(cell)]
            if group:
                jobs.append(pool.submit(run_cells, bench, group, live))
        for cell in cells:
            if cell.command == "plan":
                jobs.append(pool.submit(alone, bench, cell, plan_cell, live))
            elif cell.command == "replay":
                jobs.append(pool.submit(alone, bench, cell, replay_cell, live))
        for job in jobs:
            job.result()


# ---- Files that change under a run --------------------------------------------------------------

# A sound program of the suite does it to the file that `victim` names; see change() in deaths.c.
CHANGES = ["shrink", "empty", "remove", "scribble"]
# load: before the file is opened; loaded: after, and before anything is drawn.
CHANGE_PHASES = ["load", "loaded", "pilot", "first", "replay"]
FILE_KINDS = {
    "rows": "plugin: recorded, file: rows.txt",
    "pictures": 'plugin: recorded, file: "pictures/*.exr"',
    "streamed": 'plugin: recorded, file: "pictures/*.exr"',
    "moments": "plugin: recorded, run: moments.json, estimator: sound",
}
FILES = {"rows": "rows.txt", "pictures": "pictures/1040.exr", "streamed": "pictures/1040.exr",
         "moments": "moments.json"}


@dataclasses.dataclass(frozen=True)
class FileCell:
    kind: str
    way: str
    phase: str

    @property
    def name(self):
        return f"{self.kind}_{self.way}_{self.phase}"

    def __str__(self):
        return f"{self.kind}, {self.way}, {self.phase}"


def file_suite(cell):
    trigger = "  trigger: {plugin: process, command: [../deaths, text], primaries: 16}\n"
    victim = f"  {cell.name}: {{{FILE_KINDS[cell.kind]}}}\n"
    first, second = (trigger, victim) if cell.phase == "load" else (victim, trigger)
    tests = f"  - {{name: mean, claim: mean({cell.name}) == 0.5}}\n"
    more = ""
    if cell.kind == "moments":
        tests = f"  - {{name: mean, claim: mean({cell.name}) == mean(trigger), expect: fail}}\n"
    if cell.kind == "rows":
        tests += f"  - {{name: variance, claim: variance({cell.name}) < 1}}\n"
    if cell.kind == "streamed":
        more = '  others: {plugin: recorded, file: "../others/*.exr"}\n'
        tests = f"  - {{name: mean, claim: mean({cell.name}) == mean(others)}}\n"
    return (f"suite: {cell.name}\nestimators:\n{first}{second}{more}"
            "  sound: {plugin: analytic/normal}\ntests:\n" + tests +
            "  - {name: trigger, claim: mean(trigger) == 0.5, secondaries: 3000}\n"
            "  - {name: sound, claim: mean(sound) == 0}\n")


def make_files(bench, cell):
    folder = bench.work / cell.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / f"{cell.name}.yaml").write_text(file_suite(cell))
    (folder / "victim").write_text(FILES[cell.kind] + "\n")
    if cell.kind == "rows":
        numbers = random.Random(1)
        (folder / "rows.txt").write_text("".join(f"{numbers.random()}\n" for _ in range(1200)))
    elif cell.kind == "moments":
        shutil.copy(bench.work / "moments.json", folder)
    else:
        shutil.copytree(bench.work / "pictures", folder / "pictures", copy_function=os.link)
        victim = FILES[cell.kind]
        (folder / victim).unlink()
        shutil.copy(bench.work / victim, folder / victim)
    return folder


def change(path, way):
    """What the trigger does."""
    if way == "remove":
        path.unlink()
    elif way == "scribble":
        path.write_text("lamp on\n")
    else:
        os.truncate(path, 0 if way == "empty" else path.stat().st_size // 2)


def file_live(bench, kind):
    live = {}
    cell = FileCell(kind, "nothing", "live")
    folder = make_files(bench, cell)
    ended = bench.run("run", f"{cell.name}/{cell.name}.yaml", *report_arguments(folder))
    expect(ended.code == 0, "exit code 0 of files that do not change",
           f"{ended.code}: {ended.err}{ended.out}")
    for test in require_reports(bench, folder, 1)["suites"][0]["tests"]:
        live[test["name"]] = test
    return live


def file_cell(bench, cell, live):
    folder = make_files(bench, cell)
    suite = f"{cell.name}/{cell.name}.yaml"
    victim = folder / FILES[cell.kind]
    if cell.phase == "replay":
        ended = bench.run("run", suite, *report_arguments(folder))
        expect(ended.code == 0, "exit code 0 before the file changes", ended.err + ended.out)
        if cell.kind == "moments":
            return
        change(victim, cell.way)
        ended = bench.run("replay", f"{cell.name}/run.json", f"{cell.name}/mean")
        # The data are gone before anything is drawn: a mistake of who asks, or other numbers.
        expect(ended.code in (1, 2), "exit code 1 or 2", f"{ended.code}: {ended.out}")
        expect(ended.out + ended.err, "words", "none")
        return
    when = "hello" if cell.phase in ("load", "loaded") else "at"
    primaries, index = (1, 5) if cell.phase == "pilot" else (PRIMARIES, 3)
    (folder / "order").write_text(f"{cell.way} {when} {primaries} {index} 0\n")
    kinds = {kind: path for kind, path in REPORTS.items()}
    ended = bench.run("run", suite, *[word for kind in kinds for word in
                                      ("--report", f"{kind}={cell.name}/new_{kind}")])
    is_stack = cell.kind in ("pictures", "streamed")
    if cell.phase == "load" and not (cell.way == "shrink" and cell.kind == "rows") and not (
            cell.way == "remove" and is_stack):
        expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.out}")
        expect(victim.name in ended.err, "a message that names the file", ended.err)
        expect(not (folder / "new_json").exists(), "nothing sampled", "a report")
        return
    expect(ended.code in (0, 1, 3), "a verdict's exit code", f"{ended.code}: {ended.err}")
    for kind, path in REPORTS.items():
        expect((folder / f"new_{kind}").exists(), f"a report of kind {kind}", "none")
        (folder / f"new_{kind}").rename(folder / path)
    record = require_reports(bench, folder, 1)
    bad = {test["verdict"] for test in record["suites"][0]["tests"] if not test["ok"]}
    for test in record["suites"][0]["tests"]:
        known = live[test["name"]]
        takes = any(s["estimator"] == "nothing_live" or s["estimator"].endswith("_live")
                    for s in known["samples"])
        if takes and cell.phase == "load":
            continue  # other data: another verdict
        if takes and test["verdict"] == "error":
            expect(f"`{cell.name}`" in test["message"], f"a message that names `{cell.name}`",
                   test["message"])
            expect(victim.name in test["message"], f"a message that names {victim.name}",
                   test["message"])
            continue
        # Rows are read whole at the start; a picture may have been read before it changed.
        must = is_stack and takes and cell.phase == "loaded"
        expect(not must, f"error of `{test['name']}`", f"{test['verdict']}: {test['message']}")
        expect(test["verdict"] == known["verdict"], f"{known['verdict']} of `{test['name']}`",
               f"{test['verdict']}: {test['message']}")
    code = 0 if not bad else 3 if bad == {"inconclusive"} else 1
    expect(ended.code == code, f"exit code {code}", ended.code)


def part_files(bench, options):
    for name, first in (("pictures", 1000), ("others", 2000)):
        (bench.work / name).mkdir(exist_ok=True)
        for seed in range(first + 1, first + 65):
            subprocess.run([bench.work / "deaths", "picture", str(seed), "4",
                            bench.work / name / f"{seed}.exr"], check=True, cwd=bench.work)
    ended = bench.run("check", "mean(sound) == 0", "--estimator", "sound=analytic/normal",
                      "--report", "json=moments.json")
    expect(ended.code == 0, "a saved run", ended.err)
    for kind in FILE_KINDS:
        cells = [FileCell(kind, way, phase) for phase in CHANGE_PHASES for way in CHANGES
                 if not (kind == "moments" and phase in ("pilot", "first", "replay"))]
        cells = [cell for cell in cells if options.only in str(cell)]
        bench.cells += len(cells)
        try:
            live = file_live(bench, kind) if cells else {}
        except Failure as failure:
            bench.note(f"{kind}, unchanged", failure)
            continue
        for cell in cells:
            alone(bench, cell, file_cell, live)


# ---- Assay's own surroundings -------------------------------------------------------------------

SOUND_SUITE = """\
suite: sound
estimators:
  a: {plugin: process, command: [../deaths, binary], primaries: 16}
  sound: {plugin: analytic/normal}
tests:
  - {name: a, claim: mean(a) == 0.5}
  - {name: sound, claim: mean(sound) == 0}
"""
LEDGER = "assay-ledger 2 budget 0.01\nend 0\n"


def new_folder(bench, name):
    folder = bench.work / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    (folder / "sound.yaml").write_text(SOUND_SUITE)
    return folder


def require_one_error(ended, word):
    lines = [line for line in ended.err.splitlines() if line.startswith("assay:")]
    expect(len(lines) == 1, "one error", ended.err or "none")
    said = " ".join(ended.err.split())
    expect(word in said, f"an error that names {word}", said)


def limit_files(size):
    """For a started program: no file grows beyond it."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def report_obstacle(bench, kind, obstacle):
    folder = new_folder(bench, f"report_{kind}_{obstacle}".replace(" ", "_"))
    others = [other for other in REPORTS if other != kind]
    target = folder / REPORTS[kind]
    more = {}
    if obstacle == "full device":
        target = pathlib.Path("/dev/full")
    elif obstacle == "no such folder":
        target = folder / "none" / REPORTS[kind]
    elif obstacle == "is a folder":
        target.mkdir()
    elif obstacle == "not to be made":
        target = pathlib.Path("/proc") / REPORTS[kind]  # root may write everywhere else
    elif obstacle == "file size":
        target.write_text("old")
        more = {"preexec_fn": limit_files(60)}
        others = []
    ended = bench.run("run", f"{folder.name}/sound.yaml", "--report", f"{kind}={target}",
                      *report_arguments(folder, others), **more)
    expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.err}")
    require_one_error(ended, str(target))
    expect(not list(folder.glob(".assay-*")), "no unfinished file", list(folder.glob(".assay-*")))
    if obstacle in ("no such folder", "is a folder"):
        expect(not any((folder / REPORTS[other]).exists() for other in others), "nothing sampled",
               "reports")
        return
    if obstacle == "file size":
        expect(target.read_text() == "old", "the old report", "another")
    require_reports(bench, folder, 1, others)


# On a file system of its own that is full: what stands there at the end goes to standard output.
FULL_DISK = """mount -t tmpfs -o size=64k none "$1" && cp "$2" "$1/old" || exit 99
(cat /dev/zero >"$1/filler") 2>/dev/null
full=$1
shift 2
"$@"
code=$?
echo "left: $(cd "$full" && ls -A | tr '\n' ' ')"
cmp -s "$full/old" old && echo "the old file"
exit $code
"""


def full_disk(bench, kind, obstacle):
    folder = new_folder(bench, f"disk_{kind}")
    disk = folder / "disk"
    disk.mkdir()
    (bench.work / "old").write_text(LEDGER)
    others = [other for other in REPORTS if other not in (kind, "console")]
    words = ["--ledger", disk / "old", "--seed", "7"] if kind == "ledger" else [
        "--report", f"{kind}={disk}/old"]
    process = subprocess.run(
        ["unshare", "-m", "sh", "-c", FULL_DISK, "sh", disk, bench.work / "old", bench.assay, "run",
         f"{folder.name}/sound.yaml", *words, *report_arguments(folder, others)],
        cwd=bench.work, env=bench.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, timeout=PATIENCE)
    ended = Ended(process.returncode, process.stdout.decode(), process.stderr.decode(), 0)
    require_no_crash(ended)
    expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.err}")
    require_one_error(ended, str(disk / "old"))
    expect("the old file" in ended.out, "the old file", ended.out)
    expect("left: filler old \n" in ended.out, "no unfinished file", ended.out)
    require_reports(bench, folder, 1, others)


def can_mount():
    return subprocess.run(["unshare", "-m", "mount", "-t", "tmpfs", "none", "/mnt"],
                          stderr=subprocess.DEVNULL).returncode == 0


def standard_output(bench, kind, obstacle):
    """Standard output is full, or nobody reads it: reports in files are written all the same."""
    folder = new_folder(bench, f"output_{obstacle}".replace(" ", "_"))
    reader, writer = os.pipe()
    os.close(reader)
    full = os.open("/dev/full", os.O_WRONLY)
    process = subprocess.Popen(
        [bench.assay, "run", f"{folder.name}/sound.yaml",
         *report_arguments(folder, ["json", "html", "junit", "markdown", "metrics"])],
        cwd=bench.work, env=bench.environment, stdin=subprocess.DEVNULL,
        stdout=full if obstacle == "full" else writer, stderr=subprocess.PIPE,
        restore_signals=True)
    os.close(writer)
    os.close(full)
    ended = Ended(0, "", process.communicate(timeout=PATIENCE)[1].decode(), 0)
    ended.code = process.returncode
    require_reports(bench, folder, 1, ["json", "html", "junit", "markdown", "metrics"])
    if obstacle == "unread" and ended.code == -signal.SIGPIPE:
        return  # as of other programs
    expect(ended.code == 2, "exit code 2", ended.code)
    require_one_error(ended, "standard output")


def ledger_obstacle(bench, kind, obstacle):
    folder = new_folder(bench, f"ledger_{obstacle}".replace(" ", "_"))
    book = folder / "ledger"
    book.write_text(LEDGER if obstacle != "new, file size" else "")
    if obstacle == "new, file size":
        book.unlink()
    words = ["run", f"{folder.name}/sound.yaml", "--ledger", book, "--seed", "7"]
    if "file size" in obstacle:
        ended = bench.run(*words, preexec_fn=limit_files(60))
        expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.err}")
        require_one_error(ended, str(book))
        now = book.read_text() if book.exists() else ""
        expect(now == ("" if obstacle.startswith("new") else LEDGER), "the old ledger", now)
        expect("All 2 claims are" in ended.out, "the console report", ended.out or "none")
        return
    if obstacle == "on no disk":
        words[words.index(book)] = "/proc/ledger"
        ended = bench.run(*words)
        expect(ended.code == 2, "exit code 2", f"{ended.code}: {ended.err}")
        require_one_error(ended, "/proc/ledger")
        return
    with open(book) as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        process = subprocess.Popen([bench.assay, *map(str, words)], cwd=bench.work,
                                   env=bench.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(1)
        expect(process.poll() is None, "a run that waits for its turn", "one that ended")
        if obstacle == "locked, then free":
            fcntl.flock(held, fcntl.LOCK_UN)
        else:
            process.terminate()
        try:
            out, err = process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise Failure("an end within 10 s", "it waits for the lock") from None
    code = 0 if obstacle == "locked, then free" else 130
    expect(process.returncode == code, f"exit code {code}", f"{process.returncode}: {err}")


def stopped(bench, kind, obstacle):
    """Ended from outside at a time, each report is the old one or the whole new one."""
    name, number, moment = obstacle
    folder = new_folder(bench, f"stopped_{name}_{moment:.3f}")
    for path in REPORTS.values():
        (folder / path).write_text("old")
    process = subprocess.Popen(
        [bench.assay, "run", f"{folder.name}/sound.yaml", *report_arguments(folder)],
        cwd=bench.work, env=bench.environment, stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(moment)
    process.send_signal(number)
    try:
        out, err = process.communicate(timeout=10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise Failure("an end within 10 s", "it goes on") from None
    # Before it watches for the signal it ends by it; after its work it has ended.
    codes = {0, 130, -number} if number == signal.SIGTERM else {0, -number}
    expect(process.returncode in codes, f"exit code of {sorted(codes)}",
           f"{process.returncode}: {err}")
    new = [kind for kind, path in REPORTS.items() if (folder / path).read_text() != "old"]
    require_reports(bench, folder, 1, new)
    if process.returncode == 0:
        expect(len(new) == len(REPORTS), "all reports", new)


def part_surroundings(bench, options):
    cells = [(report_obstacle, kind, obstacle) for kind in REPORTS
             for obstacle in ("full device", "no such folder", "is a folder", "not to be made",
                              "file size")]
    cells += [(standard_output, "console", obstacle) for obstacle in ("full", "unread")]
    cells += [(ledger_obstacle, "ledger", obstacle) for obstacle in
              ("locked, then free", "locked, SIGTERM", "file size", "new, file size",
               "on no disk")]
    if can_mount():
        cells += [(full_disk, kind, "full disk") for kind in [*REPORTS, "ledger"]]
    else:
        print("no full disk: a file system cannot be mounted here")
    start = time.monotonic()
    folder = new_folder(bench, "stopped_never")
    bench.run("run", f"{folder.name}/sound.yaml", *report_arguments(folder))
    length = time.monotonic() - start
    moments = random.Random(1)
    cells += [(stopped, "all", (number.name, number, moments.uniform(0, 1.2 * length)))
              for _ in range(12) for number in (signal.SIGTERM, signal.SIGKILL)]
    for do, kind, obstacle in cells:
        text = obstacle if isinstance(obstacle, str) else f"{obstacle[0]} at {obstacle[2]:.3f} s"
        name = f"surroundings, {kind}, {text}"
        if options.only not in name:
            continue
        bench.cells += 1
        try:
            do(bench, kind, obstacle)
        except Failure as failure:
            bench.note(name, failure)


# ---- Programs killed at random times ------------------------------------------------------------

KILL_SUITE = """\
suite: kills
estimators:
  program: {plugin: process, command: [../deaths, text], primaries: 16}
  library: {plugin: library, file: ../deaths.so, primaries: 16}
  sound: {plugin: analytic/normal, primaries: 16}
tests:
  - {name: program, claim: mean(program) == 0.5, secondaries: 100000}
  - {name: library, claim: mean(library) == 0.5, secondaries: 100000}
  - {name: sound, claim: mean(sound) == 0, secondaries: 100000}
"""


def children_of(process):
    """Programs that it started: process id and the name of the estimator."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = (folder / "stat").read_text().rpartition(")")[2].split()[1]
            words = (folder / "cmdline").read_bytes()
        except OSError:
            continue
        if int(parent) == process:
            known = "program" if b"../deaths\0text" in words else (
                "library" if b"host-library" in words else None)  # not yet itself
            found.append((int(folder.name), known))
    return found


def kill_once(bench, live, moment, pick):
    folder = bench.work / "kills"
    for path in REPORTS.values():
        (folder / path).unlink(missing_ok=True)
    process = subprocess.Popen([bench.assay, "run", "kills/kills.yaml", *report_arguments(folder)],
                               cwd=bench.work, env=bench.environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(moment)
    victims = children_of(process.pid)
    victim, source = victims[int(pick * len(victims))] if victims else (None, "sound")
    if victim:
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            pass
    ended = end_of(process, time.monotonic())
    expect(ended.code in (0, 1), "exit code 0 or 1", f"{ended.code}: {ended.err}")
    bad = False
    for test in require_reports(bench, folder, 1)["suites"][0]["tests"]:
        name, verdict = test["name"], test["verdict"]
        if verdict == "error" and (name == source or source is None and name != "sound"):
            bad = True
            expect(f"`{name}`" in test["message"] and "signal 9" in test["message"],
                   f"a message that names `{name}` and signal 9", test["message"])
            continue
        expect(verdict == live[name]["verdict"], f"{live[name]['verdict']} of `{name}` where "
               f"`{source}` was killed", f"{verdict}: {test['message']}")
        expect(bare(test["samples"]) == bare(live[name]["samples"]), f"the numbers of `{name}`",
               "others")
    expect(process.returncode == (1 if bad else 0), f"exit code {1 if bad else 0}",
           process.returncode)


def part_kills(bench, options):
    folder = bench.work / "kills"
    folder.mkdir(exist_ok=True)
    (folder / "kills.yaml").write_text(KILL_SUITE)
    ended = bench.run("run", "kills/kills.yaml", *report_arguments(folder))
    expect(ended.code == 0, "exit code 0 where nobody is killed", f"{ended.code}: {ended.out}")
    live = {test["name"]: test for test in require_reports(bench, folder, 1)["suites"][0]["tests"]}
    choice = random.Random(1)
    for number in range(options.kills):
        bench.cells += 1
        moment, pick = choice.uniform(0, 1.1 * ended.seconds), choice.random()
        try:
            kill_once(bench, live, moment, pick)
        except Failure as failure:
            bench.note(f"kill -9 {number}, at {moment:.3f} s of {ended.seconds:.3f}", failure)


# ---- The program --------------------------------------------------------------------------------

PARTS = {kind.replace(" ", "_"): (lambda bench, options, kind=kind:
                                  part_matrix(bench, kind, options.only)) for kind in KINDS}
PARTS.update(files=part_files, surroundings=part_surroundings, kills=part_kills)


def left_running(work):
    """What was started here and still runs, but for what is about to end."""
    end = time.monotonic() + 3
    while True:
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                where = os.readlink(process / "cwd")
                words = (process / "cmdline").read_bytes().replace(b"\0", b" ").decode()
            except OSError:
                continue
            if where.startswith(str(work)) and words and int(process.name) != os.getpid():
                found.append((process.name, words))
        if not found or time.monotonic() > end:
            return found
        time.sleep(0.05)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("assay", type=pathlib.Path)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("parts", nargs="*", help="of " + ", ".join(PARTS))
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--list", action="store_true", help="print the cells")
    parser.add_argument("--only", default="", help="cells that hold this text")
    parser.add_argument("--keep", type=pathlib.Path, help="work here and leave it")
    options = parser.parse_args()
    if options.list:
        for cell in all_cells():
            print(cell)
        return 0
    start = time.monotonic()
    work = (options.keep or pathlib.Path(tempfile.mkdtemp(prefix="assay_deaths_"))).resolve()
    work.mkdir(exist_ok=True)
    bench = Bench(options.assay.resolve(), options.source.resolve(), work)
    try:
        for part in options.parts or PARTS:
            PARTS[part](bench, options)
        for process, words in left_running(work):
            bench.note("left running", words)
            os.kill(int(process), signal.SIGKILL)
    finally:
        if not options.keep:
            shutil.rmtree(work, ignore_errors=True)
    print(f"{bench.cells} cells, {len(bench.failures)} failures, "
          f"{time.monotonic() - start:.1f} s")
    return 1 if bench.failures else 0


if __name__ == "__main__":
    sys.exit(main())
