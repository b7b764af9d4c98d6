#!/usr/bin/env python3
"""docs/contributing/outside_data.md names every folder of outside data that a test asks for, and no other."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

page = (ROOT / "docs" / "contributing" / "outside_data.md").read_text()
told = set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE))
asked = set()
for source in [*ROOT.glob("tests/**/*_test.cpp"), *ROOT.glob("tests/**/*_check.py"), *ROOT.glob("tests/**/motion_test.cpp")]:
    text = source.read_text()
    if "OUTSIDE_DATA" in text or "VINEROW_DATA" in text or "outside_data_folder" in text:
        asked |= {folder for folder in told if f'"{folder}' in text}
        for path in re.findall(r'VINEROW_OUTSIDE_DATA\(\s*\w+,\s*(?:std::filesystem::path\()?"(\w+)', text):
            asked.add(path)
        for path in re.findall(r'k\w+\s*=\s*"(\w+)/[^"]*(?:test_plans|resources|data)', text):
            asked.add(path)

for folder in sorted(asked - told):
    print(f"docs/contributing/outside_data.md does not name {folder}, which a test asks for")
for folder in sorted(told - asked):
    print(f"docs/contributing/outside_data.md names {folder}, which no test asks for")
print(f"{len(asked)} folders of outside data")
sys.exit(asked != told)
