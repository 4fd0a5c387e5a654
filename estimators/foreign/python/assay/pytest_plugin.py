"""Tests of pytest from claims: `NAME.claims.yaml`, a suite of Assay, and functions with `@claim`.

All selected claims of a suite, or of a module, are tested by one run of the program `assay`.
"""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import subprocess
import tempfile
import textwrap
import typing
from pathlib import Path

import pytest

from assay.claims import claims_of, tests_of, write_suite

_HOW = "give --assay-program PATH, set ASSAY=PATH, or put it on PATH"
_SHARDS = ("GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX", "TEST_TOTAL_SHARDS", "TEST_SHARD_INDEX")
_PROPERTIES = ("estimate", "low", "high")


class AssayError(Exception):
    """What Assay says of a claim, or why it says nothing."""


class _Settings:
    """The program, the seed, and where suites of modules and records go."""

    def __init__(self, config: pytest.Config):
        self._wanted = config.getoption("--assay-program") or os.environ.get("ASSAY") or "assay"
        self.path = shutil.which(self._wanted)
        seed = config.getoption("--assay-seed")
        self.seed = str(random.SystemRandom().getrandbits(32)) if seed == "random" else seed
        config.option.assay_seed = self.seed  # for the workers of xdist
        self._config = config
        self._folder: Path | None = None

    @property
    def program(self) -> str:
        if self.path is None:
            raise AssayError(f"the program `{self._wanted}` is not there: {_HOW}")
        return os.path.abspath(self.path)

    @property
    def header(self) -> str:
        seed = f"seed {self.seed}" if self.seed else "seed 1, or the suite's; --assay-seed N|random"
        return f"assay: {self.path or f'`{self._wanted}` is not there: {_HOW}'}, {seed}"

    def file(self, nodeid: str, ending: str) -> Path:
        """A file of pytest's cache for a suite or a module."""
        if self._folder is None:
            cache = getattr(self._config, "cache", None)
            self._folder = Path(cache.mkdir("assay") if cache else tempfile.mkdtemp(prefix="assay-"))
        return (self._folder / nodeid.replace("..", "_")).with_suffix(ending)

    def record(self, nodeid: str) -> Path:
        """A run's record, of each worker of xdist its own."""
        worker = os.environ.get("PYTEST_XDIST_WORKER")
        return self.file(nodeid, f".{worker}.json" if worker else ".json")

    def run(self, *words: str) -> subprocess.CompletedProcess[str]:
        environment = {name: value for name, value in os.environ.items() if name not in _SHARDS}
        return subprocess.run([self.program, *words], env=environment, text=True, encoding="utf-8",
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)


_SETTINGS = pytest.StashKey[_Settings]()
_RUN = pytest.StashKey["_Run"]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("assay", "claims about Monte Carlo estimators")
    group.addoption("--assay-program", metavar="PATH", help="the program `assay`; default $ASSAY, or the one on PATH")
    group.addoption("--assay-seed", metavar="N|random", help="seed of all random numbers; default the suite's, else 1")


def pytest_configure(config: pytest.Config) -> None:
    config.stash[_SETTINGS] = _Settings(config)


def pytest_report_header(config: pytest.Config) -> str:
    return config.stash[_SETTINGS].header


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    is_suite = file_path.name.endswith((".claims.yaml", ".claims.yml"))
    if is_suite or (file_path.suffix == ".yaml" and parent.session.isinitpath(file_path)):
        return SuiteFile.from_parent(parent, path=file_path)
    return None


def pytest_pycollect_makeitem(collector: pytest.Collector, name: str, obj: object) -> list[pytest.Item] | None:
    if not claims_of(getattr(obj, "__func__", obj)):  # that of a static method
        return None
    if not isinstance(collector, pytest.Module):
        raise collector.CollectError(f"`{name}` has claims: make it a function of the module")
    if _RUN not in collector.stash:
        settings = collector.config.stash[_SETTINGS]
        suite = settings.file(collector.nodeid, ".yaml")
        claims = {f"{suite.stem}/{test}": str(each) for _, test, each in tests_of(collector.obj)}
        collector.stash[_RUN] = _Run(
            settings, suite, settings.record(collector.nodeid), claims,
            lambda ids, file: write_suite(collector.obj, file, [id.split("/", 1)[1] for id in ids]))
    stem = collector.stash[_RUN].suite.stem
    return [ClaimItem.from_parent(collector, name=test, run=collector.stash[_RUN], id=f"{stem}/{test}",
                                  line=obj.__code__.co_firstlineno)  # type: ignore[attr-defined]
            for function, test, _ in tests_of(collector.obj) if function == name]


class SuiteFile(pytest.File):
    """A suite file: an item for each of its claims."""

    def collect(self) -> typing.Iterator[pytest.Item]:
        settings = self.config.stash[_SETTINGS]
        try:
            listed = settings.run("list", "tests", str(self.path))
            ids, trouble = listed.stdout.splitlines(), listed.stderr.strip() if listed.returncode else ""
        except AssayError as error:
            ids, trouble = [], str(error)
        if trouble:
            ids = [f"/{self.path.name}"]  # the one item of a suite that cannot be read
        run = _Run(settings, self.path, settings.record(self.nodeid), dict.fromkeys(ids, ""), trouble=trouble)
        for each in ids:
            yield ClaimItem.from_parent(self, name=each.split("/", 1)[1], run=run, id=each)


class _Run:
    """The one run of a suite, for all of its claims that are selected."""

    def __init__(self, settings: _Settings, suite: Path, record: Path, claims: dict[str, str],
                 write: typing.Callable[[typing.Iterable[str], Path], None] | None = None, trouble: str = ""):
        """The claims are ids with the text of each; `write` makes a suite of some of them."""
        self.suite = suite
        self._settings, self._record, self._claims, self._write = settings, record, claims, write
        self._tests: dict[str, typing.Any] | None = {} if trouble else None
        self._trouble = trouble
        self._faults: dict[str, str] = {}

    def result(self, item: ClaimItem) -> dict[str, typing.Any]:
        if self._tests is None:
            self._tests = {}
            ids = [each.id for each in item.session.items if isinstance(each, ClaimItem) and each.run is self]
            try:
                self._start(ids)
            except (AssayError, OSError) as error:
                self._trouble = str(error)
        if item.id not in self._tests:
            raise AssayError(self._faults.get(item.id) or self._trouble or f"Assay's record has no test `{item.id}`")
        return self._tests[item.id]

    def _start(self, ids: list[str]) -> None:
        self._record.parent.mkdir(parents=True, exist_ok=True)
        self._record.unlink(missing_ok=True)
        try:
            if self._write:
                self._write(self._claims, self.suite)
        except TypeError as error:  # a function that no suite can serve
            self._trouble = str(error)
        else:
            self._test(ids, len(self._claims), self.suite)
        if self._write and not self._record.exists():
            self._faults = {id: fault for id in self._claims if (fault := self._fault(id))}
            sound = [id for id in self._claims if id not in self._faults]
            ids = [id for id in ids if id in sound]
            if self._faults and ids:  # in another file: workers of xdist share the first
                suite = self.suite.parent / "sound" / self.suite.name
                self._write(sound, suite)
                self._test(ids, len(sound), suite)
        if self._record.exists():
            record = json.loads(self._record.read_text(encoding="utf-8"))
            self._tests = {test["id"]: test for suite in record["suites"] for test in suite["tests"]}

    def _fault(self, id: str) -> str:
        """Why no suite can hold this claim; "" if one can."""
        suite = self.suite.with_suffix(f".{os.getpid()}.yaml")
        try:
            self._write([id], suite)  # type: ignore[misc]
        except TypeError as error:
            return f"{self._claims[id]}: {error}"
        planned = self._settings.run("plan", str(suite))
        for file in (suite, suite.with_suffix(".sh")):
            file.unlink()
        # The place in a file that the user did not write says nothing, nor does its line.
        said = re.sub(r"(?s:\Aassay: .*?:\d+:\d+:\s)|\n.*\n *\^\s*\Z", "", planned.stderr)
        return f"{self._claims[id]}: {' '.join(said.split())}" if planned.returncode == 2 else ""

    def _test(self, ids: list[str], claims: int, suite: Path) -> None:
        words = ["run", str(suite), "--report", f"json={self._record}", "--report", "console=/dev/null",
                 "--quiet", "--github", "never"]
        words += ["--seed", self._settings.seed] if self._settings.seed else []
        words += [word for id in ids for word in ("--filter", id)] if len(ids) < claims else []
        ended = self._settings.run(*words)
        self._trouble = ended.stderr.strip() or f"`assay run` ended with exit code {ended.returncode}"


class ClaimItem(pytest.Item):
    """One claim."""

    def __init__(self, *, run: _Run, id: str, line: int | None = None, **more: typing.Any):
        super().__init__(**more)
        self.run, self.id, self._line = run, id, line

    def runtest(self) -> None:
        test = self.run.result(self)
        self.user_properties += [("verdict", test["verdict"]), ("method", test["method"])]
        self.user_properties += [(name, test["effect"][name]) for name in _PROPERTIES]
        if test["verdict"] == "skipped":
            pytest.skip(test["message"])
        if not test["ok"]:
            raise AssayError(_words(test, in_full=self.config.option.verbose > 0))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException],
                     style: typing.Any = None) -> typing.Any:
        if isinstance(excinfo.value, AssayError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, None if self._line is None else self._line - 1, self.name


def _words(test: dict[str, typing.Any], in_full: bool) -> str:
    """The finding and what to do next; with `-v` all numbers."""
    display = test["display"]
    lines = [_wrapped(f"{display['verdict']}: {display['sentence']}", "  ")]
    if in_full:
        facts = [(fact["label"], fact["text"]) for fact in display["facts"] if fact["text"] != display["sentence"]]
        lines += [_wrapped(f"  {label:<16} {text}", " " * 19) for label, text in facts]
        lines += [_command(f"  {'replay':<16} ", test["replay"])] if test["replay"] else []
    else:
        lines += [_command(f"  {step['label']}: ", step["paste"]) if step["paste"] else
                  _wrapped(f"  {step['label']}: {step['words']}", " " * 4) for step in display["steps"]]
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}", " ")


def _command(lead: str, command: str) -> str:
    """The command in lines that a shell takes as one."""
    lines = [""]
    for word in re.findall(r"""(?:'[^']*'|"[^"]*"|\\.|[^\s'"\\])+""", command):
        if lines[-1] and len(lead) + len(lines[-1]) + 1 + len(word) > 78:
            lines[-1] += " \\"
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return lead + ("\n" + " " * len(lead)).join(lines)


def _wrapped(text: str, indent: str) -> str:
    return textwrap.fill(text, 80, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
