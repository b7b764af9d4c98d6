#!/usr/bin/env python3
"""Fails where a parameter can be stated twice: a spec made or read by hand instead of by its ParameterTable.

parameters_by_hand.txt lists the files that still do; the list may only shrink. --update takes out what is done.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = pathlib.Path(__file__).with_name("parameters_by_hand.txt")
FOLDERS = ["engine", "vehicles", "worlds", "controllers", "tools"]
# What tables are made of.
MACHINERY = {
    "engine/api/parameters.h",
    "engine/api/parameters.cpp",
    "engine/api/parameter_table.h",
    "engine/api/parameter_table.cpp",
    # Readers of JSON that is no parameter of ours.
    "engine/io/qgc_plan.cpp",
    "tools/vinerow/report/report.cpp",
    "tools/vinerow/report/run_facts.cpp",
    "tools/vinerow/report/run_folder.cpp",
    "tools/vinerow/report/verdict.cpp",
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
    listed = [line for line in LIST.read_text().splitlines() if line]
    by_hand = {}
    for folder in FOLDERS:
        for file in sorted((ROOT / folder).rglob("*")):
            name = file.relative_to(ROOT).as_posix()
            if file.suffix not in (".h", ".cpp") or name in MACHINERY:
                continue
            if faults := faults_of(file.read_text()):
                by_hand[name] = faults
    if "--update" in sys.argv:
        LIST.write_text("".join(f"{name}\n" for name in listed if name in by_hand))
        return 0
    problems = [f"{name}:{fault}" for name in by_hand if name not in listed for fault in by_hand[name]]
    problems += [f"{name} is done: take it out of {LIST.name} (--update)" for name in listed if name not in by_hand]
    for problem in problems:
        print(problem)
    print(f"{len(listed)} files still state parameters by hand")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
