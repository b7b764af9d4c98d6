#!/usr/bin/env python3
"""The generated pages of docs/reference are what `vinerow docs` writes, and links to their headings find them.

reference_pages_test.py VINEROW
"""

import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "docs" / "reference"


def anchors_of(page: str) -> set[str]:
    """As GitHub makes them: lower case, spaces as hyphens, no other punctuation than - and _."""
    headings = re.findall(r"^#+ (.*)$", page, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def lost_links(name: str, anchors: set[str]) -> list[str]:
    lost = []
    for file in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("*/**/README.md")]):
        if "node_modules" in file.parts or "build" in file.relative_to(ROOT).parts:
            continue
        for target, anchor in re.findall(r"\]\(([^)#\s]+)#([\w-]+)\)", file.read_text(encoding="utf-8")):
            if (file.parent / target).resolve() == KEPT / name and anchor not in anchors:
                lost.append(f"{file.relative_to(ROOT)}: {name} has no heading '{anchor}'")
    return lost


def main() -> int:
    faults = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], "docs", "--out", folder], check=True, capture_output=True)
        pages = sorted(pathlib.Path(folder).glob("*.md"))
        if len(pages) < 5:
            faults.append(f"only {len(pages)} pages")
        for page in pages:
            written = page.read_text(encoding="utf-8")
            kept = (KEPT / page.name).read_text(encoding="utf-8") if (KEPT / page.name).exists() else ""
            if written != kept:
                diff = difflib.unified_diff(kept.splitlines(), written.splitlines(), f"docs/reference/{page.name}", "vinerow docs", n=0, lineterm="")
                faults += list(diff)[:30] + [f"docs/reference/{page.name} is out of date: run `vinerow docs`"]
            faults += lost_links(page.name, anchors_of(written))
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
