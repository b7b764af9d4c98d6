#!/usr/bin/env python3
"""docs/reference/parts.md is what the command prints, and links to its headings find them.

parts_page_test.py VINEROW
"""

import difflib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "reference" / "parts.md"


def anchors_of(page: str) -> set[str]:
    """As GitHub makes them: lower case, spaces as hyphens, no other punctuation than - and _."""
    headings = re.findall(r"^#+ (.*)$", page, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def lost_links(anchors: set[str]) -> list[str]:
    lost = []
    for file in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("*/README.md")]):
        for anchor in re.findall(r"parts\.md#([\w-]+)\)", file.read_text(encoding="utf-8")):
            if anchor not in anchors:
                lost.append(f"{file.relative_to(ROOT)}: parts.md has no heading '{anchor}'")
    return lost


def main() -> int:
    printed = subprocess.run(
        [sys.argv[1], "list", "--markdown"], check=True, capture_output=True, encoding="utf-8"
    ).stdout
    kept = PAGE.read_text(encoding="utf-8")
    if printed != kept:
        diff = difflib.unified_diff(
            kept.splitlines(), printed.splitlines(), "docs/reference/parts.md", "vinerow list --markdown", n=0, lineterm=""
        )
        print(*list(diff)[:40], sep="\n")
        print("docs/reference/parts.md is out of date: run vinerow list --markdown > docs/reference/parts.md")
        return 1
    lost = lost_links(anchors_of(printed))
    print(*lost, sep="\n")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
