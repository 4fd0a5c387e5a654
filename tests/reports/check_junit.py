"""Reads a JUnit file as continuous integration servers do: check_junit.py JUNIT RECORD

Every test of the JSON record must be there once, with the result that its verdict demands, its place
and its numbers.
"""

import json
import sys

from junitparser import Error, Failure, JUnitXml, Skipped


def wanted_result(test):
    if test["verdict"] == "skipped":
        return Skipped
    if test["ok"]:
        return None
    return {"inconclusive": Skipped, "error": Error}.get(test["verdict"], Failure)


def check_case(case, test):
    wanted = wanted_result(test)
    kinds = [type(result) for result in case.result]
    assert kinds == ([] if wanted is None else [wanted]), (case.name, kinds, wanted)
    if wanted is Failure:
        assert case.result[0].type == test["verdict"]
        assert "replay: " in case.result[0].text
    element = case._elem
    assert element.get("file") == test["file"] and int(element.get("line")) == test["line"]
    properties = {p.get("name"): p.get("value") for p in element.iter("property")}
    if test["effect"]["estimate"] is not None:
        assert float(properties["estimate"]) == test["effect"]["estimate"]
    assert properties["verdict"] == test["verdict"]
    assert len(case.system_out.encode()) < 64 * 1024


def main(junit_path, record_path):
    xml = JUnitXml.fromfile(junit_path)
    with open(record_path, encoding="utf-8") as file:
        record = json.load(file)
    suites = list(xml)
    assert len(suites) == len(record["suites"]) + bool(record["ledger"]["file"])
    names = set()
    for suite, recorded in zip(suites, record["suites"]):
        cases = list(suite)
        assert len(cases) == len(recorded["tests"]) == suite.tests
        for case, test in zip(cases, recorded["tests"]):
            check_case(case, test)
            assert (case.classname, case.name) not in names
            names.add((case.classname, case.name))
        found = [type(r) for case in cases for r in case.result]
        assert suite.failures == found.count(Failure)
        assert suite.errors == found.count(Error)
        assert suite.skipped == found.count(Skipped)
    if record["ledger"]["file"]:
        series = record["ledger"]["series"]
        cases = list(suites[-1])
        assert len(cases) == len(series) == suites[-1].tests
        for case, recorded in zip(cases, series):
            assert bool(case.result) == recorded["alarm"]
            assert (case.classname, case.name) not in names
            names.add((case.classname, case.name))
        assert suites[-1].failures == sum(s["alarm"] for s in series)
    assert xml.tests == len(names) > 0
    print(f"{len(names)} cases read")


if __name__ == "__main__":
    main(*sys.argv[1:])
