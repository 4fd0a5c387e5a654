#!/usr/bin/env python3
"""Adds a quantity, a method, a report and an estimator to a copy: additions_test.py SOURCE BUILD

Each addition is files of its own and lines in one existing file. The changed files are compiled and
linked with the objects of the build, and the program must offer and use what was added. So an
addition that takes any other change fails here.
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

NEW_FILES = {
    "harness/families/added_method.h": """#pragma once

#include "harness/theta/methods.h"

namespace assay::harness {

Evidence added_evidence(const Seen& seen);

}  // namespace assay::harness
""",
    "harness/families/added_method.cpp": """#include "harness/families/added_method.h"

#include "harness/question/question.h"
#include "stats/means/student_t.h"

namespace assay::harness {

Evidence added_evidence(const Seen& seen) {
  const stats::Moments x = seen.moments(0);
  const double null = seen.reference().value;
  return {.estimate = x.mean - null,
          .at = [=](double t) { return stats::student_t(x, {.value = null + t}); },
          .interval =
              [=](double confidence) {
                return stats::student_t_interval(x, {.value = null}, confidence);
              },
          .quantity = "difference"};
}

}  // namespace assay::harness
""",
    "harness/families/added_quantity.h": """#pragma once

#include "harness/theta/theta.h"

namespace assay::harness {

const Theta& theta_of_second_moments();

}  // namespace assay::harness
""",
    "harness/families/added_quantity.cpp": """#include "harness/families/added_quantity.h"

#include "harness/families/families.h"
#include "harness/plan/outcome.h"
#include "stats/means/student_t.h"

namespace assay::harness {
namespace {

/// theta = E x^2 - r.
Evidence t_of_squares(const Seen& seen) {
  stats::Moments squares;
  for (const double x : seen.data[0].values) squares.add(x * x);
  const double null = seen.reference().value;
  return {.estimate = squares.mean - null,
          .at = [=](double t) { return stats::student_t(squares, {.value = null + t}); },
          .interval =
              [=](double confidence) {
                return stats::student_t_interval(squares, {.value = null}, confidence);
              },
          .quantity = "second moment"};
}

class SecondMomentTheta final : public Theta {
 public:
  SecondMomentTheta()
      : Theta({.of_single_values = true},
              {{"t-of-squares", "Student's t of the squares", any_question, Keeps::values,
                t_of_squares}}) {}
  std::optional<std::uint64_t> secondaries(const TestOutcome&, const ErrorShare&,
                                           const Pilots&) const override {
    return std::nullopt;
  }
};

}  // namespace

const Theta& theta_of_second_moments() { return one<SecondMomentTheta>(); }

}  // namespace assay::harness
""",
    "reports/formats/added_report.h": """#pragma once

#include <string>

#include "reports/record/record.h"

namespace assay::reports {

std::string added_report(const Record&);

}  // namespace assay::reports
""",
    "reports/formats/added_report.cpp": """#include "reports/formats/added_report.h"

namespace assay::reports {

std::string added_report(const Record& record) {
  return "methods: " + record.suites[0].tests[0].method + "\\n";
}

}  // namespace assay::reports
""",
    "estimators/analytic/added.cpp": """#include "estimators/estimator.h"

namespace assay::plugins {

std::vector<Entry> analytic_added() {
  return {{{.name = "analytic/added", .summary = "A uniform number.", .description = ""},
           [](Parameters&) -> std::shared_ptr<const Setup> {
             return averaging(Channel{.mean = 0.5, .variance = 1.0 / 12, .low = 0, .high = 1},
                              [](Stream& random, Cost&) { return random.uniform(); });
           }}};
}

}  // namespace assay::plugins
""",
}

# The one file that each addition changes: a line to add an #include after, a line to add a row
# before.
METHOD_ROW = """      {"added-method", "an added test of a mean", of_one, Keeps::moments, added_evidence},
"""
QUANTITY_ROW = """      {.word = "second_moment",
       .example = "second_moment(a) == 1",
       .summary = "an added quantity",
       .theta = &theta_of_second_moments()},
"""
REPORT_ROW = """      {"added", "added", "an added report",
       [](const Record& record, const ConsoleOptions&) { return added_report(record); }},
"""
EDITS = {
    "harness/families/mean.cpp": (
        '#include "harness/families/families.h"\n',
        '#include "harness/families/added_method.h"\n', '      {"batch-means",', METHOD_ROW),
    "harness/families/quantities.cpp": (
        '#include <algorithm>\n', '#include "harness/families/added_quantity.h"\n',
        '      {.word = "variance",\n', QUANTITY_ROW),
    "reports/report_formats.cpp": (
        '#include "reports/report_formats.h"\n', '#include "reports/formats/added_report.h"\n',
        '      {"junit",', REPORT_ROW),
    "estimators/CMakeLists.txt": (
        "", "", "  analytic/dart_throwing.cpp\n", "  analytic/added.cpp\n"),
}
# A file of the build that is compiled as those of a layer are.
LIKE = {
    "harness": "harness/families/mean.cpp",
    "reports": "reports/report_formats.cpp",
    "estimators": "estimators/analytic/dart_throwing.cpp",
    "build": "estimators/analytic/dart_throwing.cpp",
}


def run(*words, **options):
    ended = subprocess.run(words, capture_output=True, text=True, check=False, **options)
    if ended.returncode != 0:
        sys.exit(f"{shlex.join(map(str, words))}\n{ended.stdout}{ended.stderr}")
    return ended.stdout


def add(text, edit, path):
    after, include, before, row = edit
    for place in filter(None, (after, before)):
        assert text.count(place) == 1, f"{path}: {place!r} occurs {text.count(place)} times"
    if after:
        text = text.replace(after, after + include)
    return text.replace(before, row + before)


def command_of(commands, source):
    """The words that compile a file of the build, or the file that joins it with others, without its output."""
    if source not in commands:
        source = next(f for f in commands if "/Unity/" in f and source in pathlib.Path(f).read_text())
    words = shlex.split(commands[source])
    out = words.index("-o")
    del words[out:out + 2]
    if words[0].endswith("ccache"):
        words = words[1:]
    return [word for word in words if word not in ("-c", source)]


def main():
    source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    commands = {entry["file"]: entry["command"]
                for entry in json.loads((build / "compile_commands.json").read_text())}
    with tempfile.TemporaryDirectory() as name:
        copy = pathlib.Path(name) / "source"
        shutil.copytree(source, copy, ignore=lambda folder, names: [
            n for n in names if n in ("build", ".git", "node_modules")])
        for path, text in NEW_FILES.items():
            assert not (copy / path).exists(), path
            (copy / path).write_text(text)
        for path, edit in EDITS.items():
            (copy / path).write_text(add((copy / path).read_text(), edit, path))
        # The list of estimators is written when the project is configured.
        run("cmake", "-G", "Ninja", "-S", copy, "-B", copy / "build")
        listed = (copy / "build/estimators/catalogue_list.cpp").read_text()
        assert "analytic_added" in listed, listed
        joined, objects = {}, []
        for path in [p for p in (*NEW_FILES, *EDITS) if p.endswith(".cpp")] + [
                "build/estimators/catalogue_list.cpp"]:
            joined.setdefault(LIKE[path.split("/")[0]], []).append(f'#include "{copy / path}"\n')
        # As in the build, the files of a layer are compiled as one.
        for like, includes in joined.items():
            words = command_of(commands, str(source / like))
            words = [f"-I{copy}" if word == f"-I{source}" else word for word in words]
            words = [f"-I{copy}/estimators" if word == f"-I{source}/estimators" else word
                     for word in words]
            # The build's precompiled headers serve here too: they are all of libraries.
            words = [w for w in words if w != "-Werror"]
            text = copy / ("joined_" + like.replace("/", "_"))
            text.write_text("".join(includes))
            objects.append(text.with_suffix(".o"))
            run(*words, "-o", objects[-1], "-c", text, cwd=build)
        link = run("ninja", "-C", build, "-t", "commands", "assay").strip().splitlines()[-1]
        assay = copy / "assay"
        link = re.sub(r" -o harness/assay ", f" {' '.join(map(str, objects))} -o {assay} ", link)
        link = link.replace(": && ", "").replace(" && :", "")
        # Objects of the copy come first: they stand for files that the build has joined with others.
        link += " -Wl,--allow-multiple-definition"
        assert str(assay) in link, link
        run("bash", "-c", link, cwd=build)
        assert "added-method" in run(assay, "list", "methods")
        assert "an added test of a mean" in run(assay, "describe", "added-method")
        assert "added-method" in run(assay, "check", "--help")
        assert "t-of-squares" in run(assay, "list", "methods")
        assert "an added quantity" in run(assay, "describe", "second_moment")
        assert "an added report" in run(assay, "list", "reports")
        assert "analytic/added" in run(assay, "list", "plugins")
        said = run(assay, "check", "mean(analytic/added) == analytic", "--test", "added-method",
                   "--report", "added=-", "--report", "console=/dev/null", "--quiet")
        assert said == "methods: added-method\n", said
        claim = "second_moment(analytic/added) == 0.3333333333333333"
        said = run(assay, "check", claim)
        assert "The claim is as it should be" in said, said
        slip = subprocess.run([assay, "check", "second_momen(analytic/uniform) == 1"],
                              capture_output=True, text=True, check=False)
        assert "second_moment" in slip.stderr, slip.stderr
    print("a quantity, a method, a report and an estimator took a line or two in one file each")


if __name__ == "__main__":
    main()
