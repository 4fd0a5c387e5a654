"""Validates JSON records against the shipped schema: check_schema.py SCHEMA RECORD...

Also checks that the schema refuses what it must: an unknown key, a missing key, a number as text.
"""

import copy
import json
import sys

import jsonschema


def refused(validator, record):
    return any(True for _ in validator.iter_errors(record))


def spoiled(record):
    """Copies of a record, each with one mistake, with a name for it."""
    unknown = copy.deepcopy(record)
    unknown["suites"][0]["tests"][0]["effect"]["surprise"] = 1
    yield "an unknown key", unknown
    missing = copy.deepcopy(record)
    del missing["suites"][0]["tests"][0]["p_value"]
    yield "a missing key", missing
    text = copy.deepcopy(record)
    text["suites"][0]["alpha"] = "0.01"
    yield "a number as text", text
    version = copy.deepcopy(record)
    version["schema"] += 1
    yield "another version", version


def objects(node):
    if isinstance(node, dict):
        if node.get("type") == "object":
            yield node
        node = list(node.values())
    if isinstance(node, list):
        for child in node:
            yield from objects(child)


def main(schema_path, *record_paths):
    with open(schema_path, encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    for node in objects(schema):
        assert node["additionalProperties"] is False, node
        assert node["required"] == list(node["properties"]), node
    validator = jsonschema.Draft202012Validator(schema)
    assert record_paths
    for path in record_paths:
        with open(path, encoding="utf-8") as file:
            record = json.load(file)
        errors = [f"{path}: {list(e.absolute_path)}: {e.message}" for e in validator.iter_errors(record)]
        assert not errors, "\n".join(errors)
        for mistake, bad in spoiled(record):
            assert refused(validator, bad), f"{path}: {mistake} was let through"
    print(f"{len(record_paths)} records are valid")


if __name__ == "__main__":
    main(*sys.argv[1:])
