"""The editors' schema accepts every suite that ships and refuses what a schema can refuse.

usage: schema_test.py ROOT

Wrong suites (tests/suites/bad_*.yaml) that a schema cannot tell from right ones are listed below:
a wrong suite is refused exactly when it is not in that list.
"""

import json
import pathlib
import sys

import jsonschema
import yaml

# Rules of YAML itself that python3-yaml is lax about, of numbers written as text, of the claim
# language, of plugins, and between keys.
BEYOND_A_SCHEMA = """
allow_above_detect allow_absolute allow_in_a_proof anchor claim_block claim_distribution claim_folded claim_law
claim_mixed claim_pi claim_quoted claim_two_lines claim_within_last cost_of_a_mean detect_within detect_zero duplicate_estimator
duplicate_key duplicate_name duplicate_nested_key merge_key method over_not_ascending
over_unknown_parameter over_without_slope reference_of_a_mean reference_text reference_unknown
slope_without_over statement_glob_of_nothing statement_of_an_invalid_test
statement_on_both_sides statement_unknown_test tag unknown_estimator unknown_estimator_right unknown_parameter unknown_plugin
variance_of_zero worst_variance_of_zero
""".split()


def refusal(validator, path):
    """Why the file is refused, or None."""
    try:
        suite = yaml.safe_load(path.read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        return f"not YAML: {error}"
    error = jsonschema.exceptions.best_match(validator.iter_errors(suite))
    return error and error.message


def main():
    root = pathlib.Path(sys.argv[1])
    schema = json.loads((root / "suites/suite.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    wrong = []
    suites = sorted((root / "suites").glob("*.yaml"))
    bad = sorted((root / "tests/suites").glob("bad_*.yaml"))
    if not suites or not bad:
        wrong.append("there are no suites to test")
    for path in suites:
        why = refusal(validator, path)
        if why:
            wrong.append(f"{path} is refused: {why}")
    for path in bad:
        beyond = path.stem.removeprefix("bad_") in BEYOND_A_SCHEMA
        why = refusal(validator, path)
        if beyond and why:
            wrong.append(f"{path} is refused ({why}): take it off the list")
        if not beyond and not why:
            wrong.append(f"{path} is accepted")
    print("\n".join(wrong) or f"{len(suites)} suites accepted, {len(bad)} wrong ones looked at")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
