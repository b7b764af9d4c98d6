#!/usr/bin/env python3
"""Fails where a parameter can be stated twice: a spec made or read by hand instead of by its ParameterTable."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["engine", "vehicles", "worlds", "controllers", "tools"]
# What tables are made of.
MACHINERY = {
    "engine/api/parameters.h",
    "engine/api/parameters.cpp",
    "engine/api/parameter_table.h",
    "engine/api/parameter_table.cpp",
    # Readers of JSON that is no parameter of ours.
    "engine/io/missions/qgc_plan.cpp",
    "tools/report/report.cpp",
    "tools/report/run_facts.cpp",
    "tools/report/run_folder.cpp",
    "tools/report/verdict.cpp",
}

MAKERS = "number|positive|integer|boolean|text|choice|path|number_list|text_list|group_list|group"
READERS = "number|integer|boolean|text|numbers|texts|groups|group"
FAULTS = [
    (re.compile(rf"\b(?:{MAKERS})_parameter\("), "makes a spec by hand"),
    # A vehicle's numbers and a table's rows have a second argument.
    (re.compile(rf'\.(?:{READERS})\(\s*"[^"]*"\s*\)'), "reads a parameter by its name"),
    (re.compile(rf"\b(?:parameters|group)\.(?:{READERS}|has)\("), "reads a parameter by its name"),
    (re.compile(r"\bdemand_(?:positive|not_negative|range)\("), "checks a range by hand"),
]
COMMENT = re.compile(r"//.*")


def faults_of(text: str) -> list[str]:
    code = COMMENT.sub("", text)
    found = []
    for pattern, words in FAULTS:
        for match in pattern.finditer(code):
            line = code.count("\n", 0, match.start()) + 1
            found.append(f"{line}: {words}: {match.group(0)}")
    return found


def check_the_check() -> None:
    for wrong in (
        'number_parameter("a_m", "m", 1.0, 0.0, 2.0, "a")',
        'p.a_m = parameters.number("a_m");',
        'group.text( "kind" ) == "x"',
        'if (parameters.has("a_m"))',
        'demand_positive(who, "a_m", a_m);',
    ):
        assert faults_of(wrong), wrong
    for right in (
        '.number("a_m", "m", &P::a_m, kPositive, "a")',
        'vehicle.number("track_m", who)',
        "table().read(parameters, who)",
        "// by number_parameter()",
    ):
        assert not faults_of(right), right


def main() -> int:
    check_the_check()
    problems = []
    for folder in FOLDERS:
        for file in sorted((ROOT / folder).rglob("*")):
            name = file.relative_to(ROOT).as_posix()
            if file.suffix in (".h", ".cpp") and name not in MACHINERY:
                problems += [f"{name}:{fault}" for fault in faults_of(file.read_text())]
    print("\n".join(problems) or "no parameter is stated by hand")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
