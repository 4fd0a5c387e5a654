#!/usr/bin/env python3
"""Runs the program in terminals of three widths and reads their screens: terminal_test.py ASSAY"""
import fcntl
import os
import pathlib
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
import unicodedata

SUITE = """suite: a suite of claims
estimators:
  normal: {plugin: analytic/normal, mean: 2}
tests:
  - {name: sound, claim: mean(normal) == 2, detect: 5%}
  - {name: wrong, claim: mean(normal) == 3}
  - {name: open, claim: mean(normal) == 2, detect: 1%, secondaries: 100}
  - {name: a bug that no test of so few observations ever finds, claim: mean(normal) == 2, expect: fail}
  - {name: "wrong with a name that is so long that it fits no line: 光線追跡", claim: mean(normal) == 4}
"""
SOUND = """suite: sound
estimators:
  normal: {plugin: analytic/normal, mean: 2}
tests:
  - {claim: mean(normal) == 2, detect: 0.1%}
  - {claim: mean(normal) <= 3, secondaries: 100}
"""
SEQUENCE = re.compile("\x1b\\[([0-9;]*)([A-Za-z])")


def fail(why, *shown):
    print("FAILED:", why)
    for text in shown:
        print("---", text, sep="\n")
    sys.exit(1)


def cells(character):
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


class Screen:
    """A terminal that remembers all lines, and how often a line ran into the right edge."""

    def __init__(self, width):
        self.width, self.lines, self.column, self.wraps = width, [""], 0, 0

    def feed(self, text):
        at = 0
        while at < len(text):
            sequence = SEQUENCE.match(text, at)
            if sequence:
                at = sequence.end()
                if sequence[2] == "K":
                    self.lines[-1] = self.lines[-1][:self.column]
                elif sequence[2] != "m":
                    fail(f"a sequence that ends in {sequence[2]}")
                continue
            character, at = text[at], at + 1
            if character == "\n":
                self.lines.append("")
            elif character == "\r":
                self.column = 0
            else:
                if self.column + cells(character) > self.width:
                    self.wraps += 1
                    self.lines.append("")
                    self.column = 0
                self.lines[-1] = self.lines[-1][:self.column] + character
                self.column += cells(character)

    def shown(self):
        return "\n".join(line.rstrip() for line in self.lines)


def in_terminal(width, *words, **environment):
    """What the program writes to a terminal of this width, and its exit code."""
    mine, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
    clean = {name: value for name, value in os.environ.items()
             if name not in ("CI", "COLUMNS", "NO_COLOR", "FORCE_COLOR", "GITHUB_ACTIONS")}
    clean.update({"TERM": "xterm", "COLUMNS": "33"} | environment)
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=its, stderr=its, env=clean)
    os.close(its)
    written = b""
    while True:
        try:
            piece = os.read(mine, 65536)
        except OSError:
            break
        if not piece:
            break
        written += piece
    os.close(mine)
    return written.decode(), process.wait()


def blocks(text):
    return [block.split("\n") for block in re.split("\n\n+", text.strip("\n"))]


def check_width(assay, width):
    written, code = in_terminal(width, assay, "run", "bad.yaml", "sound.yaml", "--report",
                                "html=run.html")
    if code != 1:
        fail(f"exit code {code}", written)
    screen = Screen(width)
    screen.feed(written)
    shown = screen.shown()
    if screen.wraps:
        fail(f"{screen.wraps} lines wrapped at {width}", shown)
    live = re.findall("\r\x1b\\[K(\\[[^\r\x1b]*)", written)
    if not any("of 7 claims" in line for line in live):
        fail("no live line that counts claims", written)
    if any(len(line) >= width or "primaries" in line for line in live):
        fail("a live line that is too long, or counts draws", written)
    if "[#" in shown or "[." in shown:
        fail("the live line stays or scrolls", shown)
    told = [block for block in blocks(shown) if block[0].startswith(("✗ fail: ", "✗ pass, ", "? inc"))]
    if len(told) != 4 or max(map(len, told)) > 5 or min(map(len, told)) < 3:
        fail("not four claims in three to five lines", shown)
    if not re.search("\n✗ 3 of 7\\s+claims\\s+broken, 1\\s+undecided in .* s. False\\s+alarms:\\s+at most 2\\s+runs\\s+in"
                     "\\s+100.\n  run.html$", shown.rstrip("\n")):
        fail("no verdict with the report below", shown)
    if shown.index("✗ fail: bad/wrong") > re.search("^sound +2 hold", shown, re.M).start():
        fail("a broken claim waits for the end", shown)
    commands = re.findall("again: (assay run .*?)\n\n", shown, re.DOTALL)
    for command in commands:
        again = command.replace("assay", assay, 1)
        ended = subprocess.run(["bash", "-c", again + " --quiet"], capture_output=True, text=True,
                               check=False)
        if ended.returncode not in (1, 3):
            fail(f"the command does not repeat it: {command}", ended.stdout + ended.stderr)
    written, code = in_terminal(width, assay, "run", "bad.yml")
    screen = Screen(width)
    screen.feed(written)
    said = " ".join(screen.shown().split())
    if screen.wraps or code != 2 or "did you mean `bad.yaml`?" not in said:
        fail(f"a mistake is wider than {width}", screen.shown())
    # A line a test.
    written, _ = in_terminal(width, assay, "run", "bad.yaml", "-v")
    screen = Screen(width)
    screen.feed(written)
    if screen.wraps or len(re.findall("^  [✓✗?] ", screen.shown(), re.MULTILINE)) != 5:
        fail(f"not a line a test at {width}", screen.shown())


def check_no_live_line(assay):
    for environment in ({"CI": "true"}, {"TERM": "dumb"}):
        written, _ = in_terminal(80, assay, "run", "sound.yaml", **environment)
        if "\x1b[K" in written or "\r\x1b" in written:
            fail(f"a live line with {environment}", written)
    piped = subprocess.run([assay, "run", "sound.yaml"], capture_output=True, text=True, check=True)
    if piped.stderr or "\x1b" in piped.stdout:
        fail("a pipe gets more than text", piped.stdout, piped.stderr)
    if len(piped.stdout.splitlines()) > 4:
        fail("more than four lines of one sound suite", piped.stdout)


def main():
    assay = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.environ["XDG_CACHE_HOME"] = folder
        pathlib.Path("bad.yaml").write_text(SUITE)
        pathlib.Path("sound.yaml").write_text(SOUND)
        for width in (60, 80, 120):
            check_width(assay, width)
        check_no_live_line(assay)
        os.chdir("/")
    print("three terminals show what they should")


if __name__ == "__main__":
    main()
