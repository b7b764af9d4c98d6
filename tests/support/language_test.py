#!/usr/bin/env python3
"""Counts words of the old private dialect in docs, READMEs and comments of C++ files (also in tests/), and fails if there is one.

docs/contributing/language.md has the rules. An entry: the pattern, and what to write instead. Code in backquotes and fenced blocks does not
count, nor do the names of files. `--count` lists the counts of each folder. `--sources` also reads the strings of C++ files outside tests/.
"""

import collections
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"

WORDS = {
    r"tell(s|ing)?|told": "report, describe, show, return, state; or name the fact directly",
    r"whoever|whichever of": "name the subject",
    r"anew": "again, from scratch; 'recomputed'",
    r"(?<!dead )reckon(s|ed|ing)?": "compute, consider",
    r"dear(er|est)?": "expensive",
    r"for ever": "forever, endlessly",
    r"of nobody|by nobody|nobody's": "no vehicle, no sensor, not ... by anything",
    r"that (is|are) none|none of that": "NaN, empty, missing, not a ...",
    r"the begin of|at the begin\b|its begin\b|'s begin\b": "start, beginning",
    r"beside the (truth|paper|printed|log)": "next to, compared with",
    r"stands parked|lies parked": "is parked",
    r"hang(s)? together": "are correlated, are connected",
    r"in the way": "an obstacle, blocking",
    r"be it": "whether",
    r"thereof|therein|thereby|wherein": "of it, in it",
    r"is asked (by|for)|are asked (by|for)": "is queried by, is requested",
    r"what is (told|said)": "name it",
    r"has none|have none": "has no ..., lacks",
    r"so many": "that many; up to; or name the number",
}
CODE = re.compile(r"```.*?```|``[^`]*``|`[^`\n]*`|<!--.*?-->|\]\([^)]*\)", re.DOTALL)
# Comments and literals of C++. Literals are matched so that a // in one starts no comment; 65'536 has no literal.
TOKEN = re.compile(r"""(?P<comment>//[^\n]*|/\*.*?\*/)
                   |R"(?P<fence>[^()\\\s]{0,16})\((?P<raw>.*?)\)(?P=fence)"
                   |"(?P<string>(?:\\.|[^"\\\n])*)"
                   |(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'""", re.DOTALL | re.VERBOSE)
# A raw string has code of another language: only its comments and strings are prose.
EMBEDDED = re.compile(r"""//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""")


def prose(path: pathlib.Path, sources: bool) -> list[tuple[int, str]]:
    """Lines of prose with their numbers."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        text = CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text)
        return list(enumerate(text.split("\n"), 1))
    groups = ("comment", "string", "raw") if sources and TESTS not in path.parents else ("comment",)
    lines = []
    for token in TOKEN.finditer(text):
        group = token.lastgroup
        if group not in groups:
            continue
        pieces = [(0, token.group(group))]
        if group == "comment":
            pieces = [(0, re.sub(r"`[^`\n]*`", " ", token.group(group)))]
        elif group == "raw":
            pieces = [(found.start(), found.group(0)) for found in EMBEDDED.finditer(token.group(group))]
        for start, piece in pieces:
            lines += enumerate(piece.split("\n"), text.count("\n", 0, token.start(group) + start) + 1)
    return lines


def files() -> list[pathlib.Path]:
    names = subprocess.run(["git", "ls-files", "*.md", "*.h", "*.cpp"], cwd=ROOT, capture_output=True, text=True,
                           check=True).stdout.split()
    skip = ("docs/contributing/language.md", "docs/glossary.md", "docs/reference/parts.md")
    return [ROOT / name for name in names if not name.startswith(skip) and (ROOT / name).exists()]


def main() -> int:
    sources = "--sources" in sys.argv
    patterns = [(re.compile(rf"\b(?:{word})\b", re.IGNORECASE), instead) for word, instead in WORDS.items()]
    counts = collections.Counter()
    only = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    for path in files():
        name = path.relative_to(ROOT).as_posix()
        if only and not name.startswith(tuple(only)):
            continue
        for number, line in prose(path, sources):
            for pattern, instead in patterns:
                for found in pattern.finditer(line):
                    counts["/".join(name.split("/")[:2])] += 1
                    if "--count" not in sys.argv:
                        print(f"{name}:{number}: '{found.group(0)}': {instead}")
    if "--count" in sys.argv:
        for folder, count in counts.most_common():
            print(f"{count:6} {folder}")
    print(f"{sum(counts.values())} words of the old dialect")
    return 1 if counts else 0


if __name__ == "__main__":
    sys.exit(main())
