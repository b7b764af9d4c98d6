"""Checks schema.json against the draft's meta-schema, and that it judges cases.json as expected.

Usage: scenario_schema_check.py FOLDER. Exit status 0 right, 1 wrong, 77 when jsonschema is not installed.
cases.json is a list of [accepted, scenario].
"""

import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    sys.exit(77)
if not hasattr(jsonschema, "Draft202012Validator"):
    sys.exit(77)

folder = pathlib.Path(sys.argv[1])
schema = json.loads((folder / "schema.json").read_text())
cases = json.loads((folder / "cases.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
wrong = [case for case in cases if validator.is_valid(case[1]) != case[0]]
for accepted, scenario in wrong:
    print("expected", "accepted" if accepted else "refused", json.dumps(scenario))
sys.exit(1 if wrong or not cases else 0)
