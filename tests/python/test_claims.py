"""The plugin of pytest: suites and decorated functions as tests, one run of `assay` for them all."""

import os

import pytest

pytest_plugins = "pytester"

# Twenty claims, of which one is broken on purpose: a cube's mean is 1/4.
MODULE = '''
import assay

@assay.claim("mean(it) == 0.25", detect="3%")
@assay.claim("mean(it) == 0.26", detect="3%")
@assay.claim("variance(it) < variance(plain)")
def cube(rng):
    return rng.random() ** 3

@assay.claim("mean(it) == 0.25")
def plain(rng):
    return float(rng.random() < 0.25)

@assay.estimator(channels=["left", "right"], primaries=8)
@assay.claim("mean(it.left) == 0.5", detect="2%")
@assay.claim("mean(it.right) == 0.5", detect=0.01)
@assay.claim("mean(it.left) == 1", expect="fail", name="the left is not the whole")
def halves(rng):
    x = rng.random()
    return x, 1 - x

def test_halves_sum_to_one():
    assert sum(halves(assay.Stream())) == 1
'''
SUITE = ("suite: normal\\nestimators:\\n" + "".join(
    f"  n{i}: {{plugin: analytic/normal, mean: {i}}}\\n" for i in range(1, 14)) + "tests:\\n" + "".join(
    f"  - {{claim: mean(n{i}) == {i}, secondaries: 100}}\\n" for i in range(1, 14))).replace("\\n", "\n")


@pytest.fixture
def folder(pytester, tmp_path, monkeypatch):
    """A folder of tests, and a program before `assay` that notes each of its runs."""
    pytester.makepyfile(test_cube=MODULE)
    pytester.path.joinpath("normal.claims.yaml").write_text(SUITE)
    spy = tmp_path / "spy"
    spy.write_text(f'#!/bin/sh\necho "$@" >>{tmp_path}/runs\nexec {os.environ["ASSAY"]} "$@"\n')
    spy.chmod(0o755)
    monkeypatch.setenv("ASSAY", str(spy))
    monkeypatch.setenv("TEST_TOTAL_SHARDS", "2")  # pytest makes no shards
    monkeypatch.setenv("TEST_SHARD_INDEX", "0")
    pytester.runs = lambda: [line for line in (tmp_path / "runs").read_text().splitlines() if line.startswith("run ")]
    return pytester


def run(folder, *words):
    return folder.runpytest_inprocess("-p", "assay.pytest_plugin", *words)


def test_twenty_claims_are_tested_by_one_run_a_file_and_the_broken_one_fails(folder):
    result = run(folder, "-v")
    result.assert_outcomes(passed=20, failed=1)  # and the function that makes no claim
    result.stdout.fnmatch_lines([
        "assay: */spy, seed 1, or the suite's; --assay-seed N|random",
        "normal.claims.yaml::mean(n13) == 13 PASSED*",
        "test_cube.py::cube?mean(it) == 0.25? PASSED*",
        "test_cube.py::cube?mean(it) == 0.26? FAILED*",
        "test_cube.py::cube?variance(it) < variance(plain)? PASSED*",
        "test_cube.py::halves?the left is not the whole? PASSED*",
        "test_cube.py::test_halves_sum_to_one PASSED*",
        "*_ cube?mean(it) == 0.26? _*",
        "fail: mean(cube) is * below 0.26 (*).",
        "  message          relative difference from the reference is -*",
        "  claim            mean(cube) == 0.26",
        "  replay           assay run *",
        "*test_cube.yaml *",
        "*--seed 1 --filter 'test_cube/cube?mean(it) == 0.26?'"])
    assert len(folder.runs()) == 2
    assert not any("--filter" in each for each in folder.runs())


def command_after(lead, lines):
    """The words of a command that may take several lines."""
    import shlex

    rest = iter(lines)
    text = next(line for line in rest if line.startswith(lead)).removeprefix(lead)
    while text.endswith("\\"):
        text = text[:-1] + next(rest)
    return shlex.split(text)


def test_the_replay_line_finds_the_same(folder):
    import subprocess

    result = run(folder, "-v", "-k", "0.26")
    finding = next(line for line in result.outlines if line.startswith("  message "))
    words = command_after("  replay ", result.outlines)
    short = run(folder, "-k", "0.26").outlines
    assert command_after("  again: ", short) == words
    assert not [line for line in short if line.startswith("  ") and len(line) > 80 and len(line.split()) > 2]
    assert not [line for line in short if line.startswith(("  message ", "  evidence "))]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    ended = subprocess.run([os.environ["ASSAY"], *words[1:], "-vv", "--shard", "1/1"], capture_output=True,
                           text=True, check=False, cwd="/", env=environment)
    assert ended.returncode == 1, ended.stderr
    assert " ".join(finding.split()[1:]) in " ".join(ended.stdout.split())


def test_a_name_without_a_function_fails_alone(folder):
    text = MODULE + """
@assay.claim("mean(cubes) == 0.25")
def more(rng):
    return rng.random()
"""
    folder.makepyfile(test_cube=text)
    result = run(folder, "-k", "more or plain")
    result.assert_outcomes(passed=2, failed=1, deselected=19)
    assert "has no function `cubes`; did you mean `cube`?" in " ".join(result.stdout.str().split())


def test_a_mistake_that_planning_or_serving_meets_fails_its_claim_alone(pytester):
    pytester.makepyfile(test_three="""
import assay

@assay.claim("mean(it) == 0.5", detect="5%")
def sound(rng):
    return rng.random()

@assay.claim("mean(it) == 0.5", allow="2%", detect="1%")
def narrow(rng):
    return rng.random()

@assay.claim("mean(it) == 0.5")
def scaled(rng, scale):
    return scale * rng.random()

@assay.claim("mean(it) == 1")
def lone():
    return 1

@assay.claim("mean(it) == 1", expect="error")
def raising(rng):
    raise ValueError("no light")
""")
    result = run(pytester)
    result.assert_outcomes(passed=2, failed=3)
    result.stdout.fnmatch_lines(["@assay.claim('mean(it) == 0.5', allow='2%', detect='1%'): *`detect`*",
                                 "@assay.claim('mean(it) == 0.5'): *`scaled` has the parameter `scale` without a value:*",
                                 "@assay.claim('mean(it) == 1'): *`lone` takes no argument:*"])


def test_a_decorator_without_a_claim_is_refused(folder):
    folder.makepyfile(test_bare="import assay\n@assay.claim\ndef area(rng):\n    return rng.random()\n")
    result = run(folder, "test_bare.py")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(['*a claim is a text, as in @assay.claim("mean(it) == 0.25")'])


def test_k_selects_and_the_numbers_are_those_of_the_whole_run(folder):
    whole = [line for line in run(folder).outlines if "0.26 (" in line]
    result = run(folder, "-k", "cube and 0.26")
    result.assert_outcomes(failed=1, deselected=20)
    assert [line for line in result.outlines if "0.26 (" in line] == whole
    assert folder.runs()[2:] == [each for each in folder.runs()[2:] if each.count("--filter") == 1]
    assert len(folder.runs()) == 3


def test_an_id_selects_the_claims_of_a_function(folder):
    run(folder, "test_cube.py::halves").assert_outcomes(passed=3)
    run(folder, "normal.claims.yaml::mean(n2) == 2").assert_outcomes(passed=1)


def test_x_stops_at_the_first_that_fails(folder):
    run(folder, "-x").assert_outcomes(passed=14, failed=1)


def test_collecting_runs_nothing(folder):
    result = run(folder, "--collect-only", "-q")
    assert len([line for line in result.outlines if "::" in line]) == 21
    assert "test_cube.py::cube[mean(it) == 0.25]" in result.outlines
    assert folder.runs() == []


def test_the_seed_can_be_given_and_stands_in_the_header(folder):
    result = run(folder, "--assay-seed", "17", "-k", "0.26")
    result.stdout.fnmatch_lines(["assay: */spy, seed 17", "*--seed 17 --filter*"])
    drawn = run(folder, "--assay-seed", "random", "-k", "0.26").outlines
    seed = next(line for line in drawn if line.startswith("assay: ")).rsplit(" ", 1)[1]
    assert seed.isdigit() and seed not in ("1", "17")
    assert f"--seed {seed} " in "\n".join(drawn)


def test_workers_of_xdist_have_records_of_their_own(folder, monkeypatch):
    monkeypatch.setenv("PYTEST_XDIST_WORKER", "gw3")
    run(folder, "-k", "n1").assert_outcomes(passed=5, deselected=16)
    records = [each.name for each in (folder.path / ".pytest_cache/d/assay").glob("*.json")]
    assert records == ["normal.claims.gw3.json"]


def test_a_quantity_may_have_several_functions(tmp_path):
    import types

    from assay.claims import claim, write_suite

    module = types.ModuleType("two")
    module.__file__ = "two.py"
    module.first = claim("covariance(second, it.left, 0.5) == normal(0, 1)")(lambda rng: 0.0)
    module.second = lambda rng: 0.0
    write_suite(module, tmp_path / "two.yaml")
    text = (tmp_path / "two.yaml").read_text()
    assert "covariance(second, first.left, 0.5) == normal(0, 1)" in text
    assert "  first: " in text and "  second: " in text


def test_properties_stand_in_the_junit_file(folder):
    run(folder, "-k", "0.26", "--junitxml", "j.xml")
    text = (folder.path / "j.xml").read_text()
    assert '<property name="verdict" value="fail"' in text and '<property name="estimate" value="-0.' in text


def test_numbers_do_not_depend_on_the_folder(folder):
    def low():
        run(folder, "-k", "0.26", "--junitxml", "j.xml")
        return (folder.path / "j.xml").read_text().split('name="low" value="')[1].split('"')[0]

    here = low()
    other = folder.mkdir("other")
    (folder.path / "test_cube.py").rename(other / "test_cube.py")
    assert low() == here


@pytest.mark.parametrize("words", [[], ["--assay-program", "no-assay"]])
def test_a_missing_program_is_said_with_what_to_do(folder, monkeypatch, words):
    monkeypatch.delenv("ASSAY")
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    name = words[-1] if words else "assay"
    mend = f"`{name}` is not there: give --assay-program PATH, set ASSAY=PATH, or put it on PATH"
    result = run(folder, *words)
    # Tests without claims run all the same.
    result.assert_outcomes(passed=1, failed=8)
    result.stdout.fnmatch_lines([f"assay: {mend}*", "*normal.claims.yaml*", f"*{mend}"])


def test_the_program_is_found_by_option_and_path(folder, monkeypatch, tmp_path):
    program = os.environ["ASSAY"]
    monkeypatch.setenv("ASSAY", "nowhere")
    run(folder, "-k", "n1", "--assay-program", program).assert_outcomes(passed=5, deselected=16)
    monkeypatch.delenv("ASSAY")
    os.symlink(program, tmp_path / "assay")
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    run(folder, "-k", "n1").assert_outcomes(passed=5, deselected=16)


def test_other_verdicts_fail_with_their_message_and_what_is_missing_is_skipped(pytester):
    pytester.path.joinpath("more.claims.yaml").write_text('''suite: more
estimators:
  n: {plugin: analytic/normal}
  broken: {plugin: process, command: [sh, -c, "exit 3"]}
tests:
  - {name: undecided, claim: mean(n) within 1e-6 of 1e-5, budget: 1e6}
  - {name: no program, claim: mean(broken) == 0}
  - {name: never expected, claim: mean(n) == 0, expect: invalid}
''')
    pytester.path.joinpath("skipped.claims.yaml").write_text('''suite: skipped
needs: [no-such-program]
estimators:
  n: {plugin: analytic/normal}
tests:
  - claim: mean(n) == 0
''')
    result = run(pytester, "-v", "-rs")
    result.assert_outcomes(failed=3, skipped=1)
    result.stdout.fnmatch_lines(["inconclusive: *", "*neither shown nor refuted*", "error: *exit status 3*",
                                 "pass, but invalid expected: *",
                                 "SKIPPED *needs the program `no-such-program`*"])


def test_mistakes_are_told_in_the_words_of_assay(pytester):
    pytester.path.joinpath("wrong.claims.yaml").write_text("suite: wrong\nestimators: {}\ntets: []\n")
    result = run(pytester)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*wrong.claims.yaml:3:1:", "*unknown key `tets`*"])
    pytester.path.joinpath("wrong.claims.yaml").unlink()
    pytester.makepyfile('''
import assay

@assay.claim("maen(it) == 1", detect="1%")
@assay.claim("mean(it) == 1")
def mine(rng):
    return 1

class TestMine:
    @staticmethod
    @assay.claim("mean(it) == 1")
    def inside(rng):
        return 1
''')
    run(pytester).stdout.fnmatch_lines(["*`inside` has claims: make it a function of the module*"])
    path = next(pytester.path.glob("test_*.py"))
    path.write_text(path.read_text().split("class")[0])
    result = run(pytester)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["@assay.claim('maen(it) == 1', detect='1%'): *did you mean `mean`*"])
    run(pytester, "-k", "mean").assert_outcomes(passed=1, deselected=1)
    # Assay wraps what it says; the last words are the mend.
    path.write_text(path.read_text().replace("maen(it) ==", "mean(it) ="))
    run(pytester).stdout.fnmatch_lines(["@assay.claim('mean(it) = 1', detect='1%'): *did you mean `==`?"])


def test_an_exception_of_a_function_is_an_error_with_its_line(pytester):
    pytester.makepyfile(test_breaks='''
import assay

@assay.claim("mean(it) == 1")
def mine(rng):
    return 1 / (rng.random() > 0.01)
''')
    result = run(pytester)
    result.assert_outcomes(failed=1)
    said = " ".join(result.stdout.str().split())
    assert "error: `mine` stopped in the pilot" in said
    assert "ends with: ZeroDivisionError: division by zero, at test_breaks.py:5 in mine" in said


def test_a_module_finds_what_pytest_finds(pytester):
    """Its package, what `pythonpath` names, and files in the folder where pytest was started."""
    pytester.makeini("[pytest]\npythonpath = lib\n")
    pytester.mkdir("lib").joinpath("third.py").write_text("THIRD = 3\n")
    package = pytester.mkpydir("package")
    package.joinpath("neighbour.py").write_text("HALF = 0.5\n")
    pytester.path.joinpath("number.txt").write_text("2")
    package.joinpath("test_here.py").write_text('''
import assay
from third import THIRD
from .neighbour import HALF

@assay.claim("mean(it) == 1.5", detect="3%")
def mine(rng):
    return rng.random() * float(open("number.txt").read()) * HALF * THIRD
''')
    run(pytester).assert_outcomes(passed=1)


def test_a_suite_of_any_name_is_taken_if_it_is_named(folder):
    (folder.path / "normal.claims.yaml").rename(folder.path / "normal.yaml")
    run(folder, "normal.yaml").assert_outcomes(passed=13)
    run(folder).assert_outcomes(passed=7, failed=1)
