"""`assay.serve`: what a program of the package answers, byte by byte, and what `assay` makes of it."""

import json
import math
import os
import random
import struct
import subprocess
import sys

import pytest

FIRST = (12345678901234567890, 3, 4, 5)  # key, first, count, primaries


class Program:
    """A program that is asked questions as Assay asks them."""

    def __init__(self, folder, body, *words):
        file = folder / "mine.py"
        file.write_text("import assay, math\n" + body)
        self.child = subprocess.Popen([sys.executable, str(file), *words], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def hello(self):
        lines = []
        while not lines or lines[-1].split(" ")[0] not in ("ready", "error"):
            line = self.child.stdout.readline().decode()
            assert line, self.child.stderr.read().decode()
            lines.append(line.rstrip("\n"))
        return lines

    def ask(self, question, numbers, items=b""):
        """The numbers of the reply, whose end is the question itself."""
        words = struct.pack("<4Q", *question)
        self.child.stdin.write(words + items)
        self.child.stdin.flush()
        reply = self.child.stdout.read(8 * numbers + 32)
        assert reply[8 * numbers:] == words
        return list(struct.unpack(f"<{numbers}d", reply[:8 * numbers]))

    def ending(self):
        out, errors = self.child.communicate()
        return self.child.returncode, out, errors.decode()


@pytest.fixture
def program(tmp_path):
    started = []

    def start(body, *words):
        started.append(Program(tmp_path, body, *words))
        return started[-1]

    yield start
    for each in started:
        each.child.kill()
        each.child.communicate()


def stream(key, index):
    return random.Random(key << 64 | index)


def test_a_primary_is_averaged_from_the_stream_of_key_and_index(program):
    mine = program("assay.serve(lambda rng: rng.random() ** 3)")
    assert mine.hello() == ["assay 1 binary", "channel value", "averages", "ready"]
    key, first, count, primaries = FIRST
    expected = []
    for index in range(first, first + count):
        rng = stream(key, index)
        expected.append(math.fsum(rng.random() ** 3 for _ in range(primaries)) / primaries)
    assert mine.ask(FIRST, 4) == expected
    # Alone, and after other questions, it is the same.
    assert mine.ask((key, 5, 1, primaries), 1) == expected[2:3]
    assert mine.ending()[0] == 0


def test_an_observation_of_its_own_is_no_average_unless_it_says_so(program):
    body = "assay.serve(lambda rng, primaries: rng.gauss(0, 1) / primaries{})"
    mine = program(body.format(""))
    assert "averages" not in mine.hello()
    # The second half of a pair of normal numbers does not outlive an observation.
    assert mine.ask((1, 0, 2, 4), 2) == [stream(1, i).gauss(0, 1) / 4 for i in range(2)]
    assert "averages" in program(body.format(", averages=True")).hello()


def test_the_declaration_is_the_hello(program):
    mine = program('''
assay.serve(lambda rng: (1, 2), bias="unbiased", rays=True, channels=[
    assay.Channel("area", mean=0.1, error=1e-3, variance=2, low=0, high=math.inf, rounding=1e-12),
    assay.Channel("depth", diagnostic=True)],
    samplers=[assay.Sampler("lens", "square", None, None, rounding=1e-7),
              assay.Sampler("ramp", "interval", None, None, high=2)])''')
    assert mine.hello() == [
        "assay 1 binary",
        "channel area mean 0.1 error 0.001 variance 2.0 low 0.0 high inf rounding 1e-12",
        "channel depth diagnostic", "averages", "bias unbiased", "rays",
        "sampler lens square rounding 1e-07", "sampler ramp interval low 0.0 high 2.0", "ready"]


def test_decorated_functions_are_served_as_declared(program):
    mine = program('''
@assay.estimator(channels=["left", "right"])
def mine(rng):
    return rng.random(), 1
assay.serve(mine)''')
    assert mine.hello()[1:3] == ["channel left", "channel right"]
    assert mine.ask((7, 1, 1, 1), 2) == [stream(7, 1).random(), 1]


def test_rays_follow_each_observation(program):
    mine = program('''
def mine(rng):
    rng.rays += 2
    return 1
assay.serve(mine, rays=True)''')
    mine.hello()
    assert mine.ask((1, 0, 2, 3), 4) == [1, 6, 1, 6]


PICTURE = '''
def mine(rng):
    a = rng.random()
    return {}
assay.serve(mine, image=assay.Image(3, 2, ("R", "G"), low=0, independent=True){})'''
NESTED = "[[[a + 10 * y + x, -a] for x in range(3)] for y in range(2)]"


@pytest.mark.parametrize("value", [
    NESTED, f"sum(sum({NESTED}, []), [])", f"numpy.array({NESTED})",
    f"numpy.array({NESTED}, order='F')", f"numpy.array({NESTED}).ravel()"])
def test_pictures_are_nested_lists_rows_or_arrays(program, value):
    mine = program("import numpy" + PICTURE.format(value, ""))
    assert mine.hello()[1:4] == ["image 3 2 R G", "independent", "range 0.0 inf"]
    rng = stream(9, 4)
    draws = [rng.random(), rng.random()]
    mean = [sum(c) / 2 for c in zip(*([n for y in range(2) for x in range(3) for n in (a + 10 * y + x, -a)]
                                      for a in draws))]
    assert mine.ask((9, 4, 1, 2), 12) == mean


def test_pictures_of_single_precision_and_further_channels(program):
    mine = program("import numpy" + PICTURE.format(
        f"numpy.array({NESTED}, dtype=numpy.float32), a", ", channels=[assay.Channel('first', diagnostic=True)]"))
    mine.hello()
    reply = mine.ask((9, 4, 1, 1), 13)
    assert reply[12] == stream(9, 4).random()
    assert reply[0] == struct.unpack("<f", struct.pack("<f", reply[12]))[0]


def test_the_stream_of_numpy_is_a_function_of_key_and_index(program):
    mine = program("assay.serve(lambda rng: rng.numpy.random())")
    mine.hello()
    both = mine.ask((1 << 63, 0, 2, 2), 2)
    assert both[0] != both[1]
    assert mine.ask((1 << 63, 1, 1, 2), 1) == both[1:]
    assert mine.ask((3, 1, 1, 2), 1) != both[1:]


def test_numpy_need_not_be_there(program):
    mine = program("import sys; sys.modules['numpy'] = None\n"
                   "assay.serve(lambda rng: [[1, 2], [3, rng.random()]], image=assay.Image(2, 2, ('Y',)))")
    assert mine.hello()[1] == "image 2 2 Y"
    assert mine.ask((5, 6, 1, 1), 4) == [1, 2, 3, stream(5, 6).random()]


def test_seeds_of_renderers_are_those_of_the_plugin_command():
    import assay

    rng = assay.Stream()
    prime = 2**31 - 1
    seeds = set()
    for index in range(10000):
        rng.begin(2**64 - 5, index)
        seeds.add(rng.render_seed)
    assert len(seeds) == 10000
    assert min(seeds) >= 1 and max(seeds) <= prime
    rng.begin(prime - 1, 1)  # tests/estimators/foreign/command_test.cpp
    assert rng.render_seed == 1


def test_what_is_printed_and_read_leaves_the_protocol_alone(program):
    mine = program('''
import os, subprocess, sys
def mine(rng):
    print("five"); os.write(1, b"six"); subprocess.run(["sh", "-c", "cat; echo seven"])
    return len(sys.stdin.read())
assay.serve(mine)''')
    mine.hello()
    assert mine.ask((1, 0, 1, 1), 1) == [0]
    status, _, errors = mine.ending()
    assert status == 0
    assert all(word in errors for word in ("five", "six", "seven"))


PARAMETERS = '''
def mine(rng, radius=2.0, *, count: int, sharp: bool = False, name="a"):
    return radius * count if sharp and name == "b" else 0
assay.serve(mine)'''


def test_parameters_come_from_the_command(program):
    mine = program(PARAMETERS, "count=3", "sharp=true", "name=b", "radius=1e1")
    mine.hello()
    assert mine.ask((1, 0, 1, 1), 1) == [30]


@pytest.mark.parametrize("words, answer", [
    (["cuont=3"], "ValueError: there is no parameter `cuont=3`; the estimator's are: radius, count, sharp, name"),
    ([], "ValueError: the parameter `count` is missing: add `count=VALUE` to the command, "
         "or give it a default value; fixtures do not fill it"),
    (["count=3.5"], "ValueError: the parameter `count=3.5` is no int"),
    (["count=3", "sharp=maybe"], "ValueError: the parameter `sharp=maybe` is no bool")])
def test_wrong_parameters_refuse(program, words, answer):
    mine = program(PARAMETERS, *words)
    assert mine.hello() == ["assay 1 binary", f"error {answer}"]
    assert mine.ending()[0] == 1


@pytest.mark.parametrize("body, line", [
    ("def mine(rng):\n  rng.random()\nassay.serve(mine)",
     "TypeError: the estimate is None: does the function end with `return`?"),
    ("def mine(rng):\n  return 1 / 0\nassay.serve(mine)",
     "ZeroDivisionError: division by zero, at mine.py:3 in mine"),
    ("def mine(rng):\n  raise ValueError('no\\n light')\nassay.serve(mine)",
     "ValueError: no light, at mine.py:3 in mine"),
    ("assay.serve(lambda rng: (1, 2))",
     "TypeError: the estimate is (1, 2), not 1 number: name the channels, or the image"),
    ("assay.serve(lambda rng, primaries: (1, 2))", "TypeError: the estimate is (1, 2), not 1 number"),
    ("assay.serve(lambda rng: (1, 2), channels=['a', 'b', 'c'])",
     "ValueError: the estimate has 2 numbers or rows where 3 are declared"),
    ("assay.serve(lambda rng: 3, channels=['a', 'b'])",
     "TypeError: the estimate is 3, not 2 numbers: name the channels, or the image"),
    ("import numpy\nassay.serve(lambda rng: numpy.zeros((3, 2)), image=assay.Image(3, 2))",
     "ValueError: the estimate has the shape (3, 2), not (2, 3, 3)"),
    ("assay.serve(lambda rng: [[1, 2], [3]], image=assay.Image(2, 2, ['Y']))",
     "ValueError: the estimate has 1 numbers or rows where 2 are declared")])
def test_an_exception_ends_the_program_with_its_last_line(program, body, line):
    mine = program(body)
    mine.hello()
    mine.child.stdin.write(struct.pack("<4Q", 1, 0, 1, 1))
    status, out, errors = mine.ending()
    assert (status, out) == (1, b"")
    assert errors.splitlines()[-1].startswith(line)


@pytest.mark.parametrize("arguments, answer", [
    ("", "`mine` takes no argument: write `def mine(rng):` and draw from `rng`"),
    ("rng, primaries, scale",
     "`mine` has the parameter `scale` without a value: give it a default value, or write `*` before it; "
     "only `primaries` is given"),
    ("rng, sigma",
     "`mine` has the parameter `sigma` without a value: give it a default value, or write `*` before it; "
     "only `primaries` is given")])
def test_a_function_of_other_arguments_refuses(program, arguments, answer):
    mine = program(f"def mine({arguments}):\n  return 1\nassay.serve(mine)")
    assert mine.hello() == ["assay 1 binary", f"error TypeError: {answer}"]


@pytest.mark.parametrize("draw, domain, more, wanted", [
    ("0.5", "interval", "", "(point, density), not 0.5"),
    ("(0.5, 0.25)", "square", "", "(point, density), not (0.5, 0.25)"),
    ("(0.5, 1)", "interval", ", evaluate=lambda x: x", "(point, density, weight), not (0.5, 1)")])
def test_a_draw_says_what_it_must_return(program, draw, domain, more, wanted):
    mine = program(f"one = assay.Sampler('one', '{domain}', lambda rng: {draw}, lambda x: 1{more})\n"
                   "assay.serve(lambda rng: 1, samplers=[one])")
    mine.hello()
    mine.child.stdin.write(struct.pack("<6Q", 0, 0, 1, 0, 8, 0))
    assert f"TypeError: draw() of `one` must return {wanted}" in mine.ending()[2]


RAMP = '''
ramp = assay.Sampler("ramp", "interval", high=2, draw=lambda rng: draw(rng), density=lambda x: x / 2,
                     evaluate=lambda x: {})
def draw(rng):
    if rng.random() < 0.25:
        return None
    x = 2 * rng.random() ** 0.5
    return x, x / 2, {} / (x / 2)
disc = assay.Sampler("disc", "square", draw=lambda rng: ((rng.random(), rng.random()), 1), density=lambda p: 1)
up = assay.Sampler("up", "sphere", draw=lambda rng: ((0, 0, 1), 0.5, 2), density=lambda p: p[2],
                   evaluate=lambda p: p[0] + 2 * p[1])
assay.serve(lambda rng: rng.random(), samplers=[ramp, disc, up])'''


def test_samplers_answer_for_draws_densities_and_evaluations(program):
    mine = program(RAMP.format("x * x", "x * x"))
    mine.hello()
    streams = [(8, i) for i in range(20)]
    reply = mine.ask((0, 0, 20, 0), 120, b"".join(struct.pack("<2Q", *each) for each in streams))
    missed = 0
    for i, each in enumerate(streams):
        rng = stream(*each)
        if rng.random() < 0.25:
            missed += 1
            assert reply[6 * i + 5] == 0
            continue
        x = 2 * rng.random() ** 0.5
        assert reply[6 * i:6 * i + 6] == [x, 0, 0, x / 2, x * x / (x / 2), 1]
    assert 0 < missed < 20
    assert mine.ask((0, 4 + 1, 2, 0), 2, struct.pack("<6d", 1, 0, 0, 1.5, 0, 0)) == [0.5, 0.75]
    assert mine.ask((0, 2, 1, 0), 1, struct.pack("<3d", 1.5, 0, 0)) == [2.25]
    # Without `evaluate` the weight is 1.
    rng = stream(8, 0)
    assert mine.ask((1, 0, 1, 0), 6, struct.pack("<2Q", 8, 0)) == [rng.random(), rng.random(), 0, 1, 1, 1]
    assert mine.ask((2, 0, 1, 0), 6, struct.pack("<2Q", 8, 0)) == [0, 0, 1, 0.5, 2, 1]
    assert mine.ask((2, 2, 1, 0), 1, struct.pack("<3d", 3, 5, 7)) == [13]


def assay_run(folder, estimators, claims, expected):
    """The verdicts of a suite by their claims, and what was said on standard error."""
    suite = ["suite: s", "estimators:", *(f"  {line}" for line in estimators), "tests:",
             *(f"  - {{name: '{claim}', claim: {claim}{keys}}}" for claim, keys in claims)]
    (folder / "s.yaml").write_text("\n".join(suite))
    ended = subprocess.run([os.environ["ASSAY"], "run", "s.yaml", "--report", "json=s.json", "--quiet"],
                           cwd=folder, capture_output=True, text=True, check=False)
    assert ended.returncode == expected, ended.stderr + ended.stdout
    if not (folder / "s.json").exists():
        return {}, " ".join(ended.stderr.split())
    tests = json.loads((folder / "s.json").read_text())["suites"][0]["tests"]
    return {test["name"]: test for test in tests}, ended.stderr


MINE = f"mine: {{plugin: process, command: [{sys.executable}, mine.py]}}"


def test_assay_confirms_a_sampler_and_catches_a_wrong_weight(tmp_path):
    claims = [("distribution(mine.disc) == density", ""), ("integral(mine.ramp) == 1", ""),
              ("inconsistency(mine.ramp) == 0", "")]
    file = tmp_path / "mine.py"
    body = "import assay\n" + RAMP.replace("if rng.random() < 0.25", "if False")
    file.write_text(body.format("x * x", "x * x"))
    assay_run(tmp_path, [MINE], claims, 0)
    file.write_text(body.format("x * x", "x"))
    tests, _ = assay_run(tmp_path, [MINE], claims, 1)
    assert [test["verdict"] for test in tests.values()] == ["pass", "pass", "fail"]


def test_assay_takes_pictures_channels_and_parameters(tmp_path):
    (tmp_path / "mine.py").write_text('''import assay
def mine(rng, scale=1.0):
    return [[scale * rng.random() for x in range(4)] for y in range(4)], scale
assay.serve(mine, image=assay.Image(4, 4, ["Y"], low=0, independent=True),
            channels=[assay.Channel("scale", diagnostic=True)])''')
    twice = f"twice: {{plugin: process, command: [{sys.executable}, mine.py, scale=2]}}"
    tests, _ = assay_run(tmp_path, [MINE, twice], [
        ("mean(mine) == mean(mine)", ""), ("mean(twice.scale) == 2", ""),
        ("mean(twice) == mean(mine)", ", expect: fail")], 0)
    assert [test["verdict"] for test in tests.values()] == ["pass", "pass", "fail"]


def test_assay_tells_the_last_line_of_an_exception(tmp_path):
    (tmp_path / "mine.py").write_text('''import assay
def mine(rng):
    return 1 / (rng.random() > 0.01)
assay.serve(mine)''')
    tests, _ = assay_run(tmp_path, [MINE], [("mean(mine) == 1", "")], 1)
    message = tests["mean(mine) == 1"]["message"]
    assert message.endswith("standard error ends with: ZeroDivisionError: division by zero, at mine.py:3 in mine")
    assert tests["mean(mine) == 1"]["verdict"] == "error"


def test_assay_refuses_wrong_parameters_before_anything_is_drawn(tmp_path):
    (tmp_path / "mine.py").write_text("import assay\nassay.serve(lambda rng, scale=1.0: scale)")
    wrong = f"mine: {{plugin: process, command: [{sys.executable}, mine.py, scael=2]}}"
    _, said = assay_run(tmp_path, [wrong], [("mean(mine) == 1", "")], 2)
    assert "there is no parameter `scael=2`; the estimator's are: scale" in said
