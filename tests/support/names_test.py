#!/usr/bin/env python3
"""A name has one meaning.

- Sources of a folder are compiled together, so a name in an anonymous namespace of one must not stand in another's. Most such
  pairs do not compile; two functions of one name and other arguments do, and may then be called for each other.
- Two types of one name in one namespace break the one-definition rule wherever one library holds both.

Names are read by Universal Ctags; without it the test is skipped.
"""

import collections
import json
import shutil
import subprocess
import sys
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
FOLDERS = ["engine", "vehicles", "worlds", "controllers", "tools"]
# Members belong to their struct, and an alias of the same type may stand twice.
HARMLESS = {"member", "enumerator", "typedef", "using", "parameter", "local"}


TYPES = {"class", "struct", "enum", "union"}


def tags(sources):
    command = ["ctags", "--languages=C++", "--langmap=C++:+.h", "--kinds-C++=+p", "--fields=+Kst", "--output-format=json", "-o", "-", *sources]
    for line in subprocess.run(command, cwd=TREE, capture_output=True, text=True, check=True).stdout.splitlines():
        tag = json.loads(line)
        if tag.get("_type") == "tag":
            yield tag


def private_names(tags):
    """Places of what anonymous namespaces hold, by (folder, name)."""
    places = collections.defaultdict(set)
    for tag in tags:
        path = Path(tag["path"])
        if path.suffix != ".cpp" or tag["kind"] in HARMLESS or tag.get("scopeKind") != "namespace":
            continue
        if tag.get("scope", "").split("::")[-1].startswith("__anon"):
            places[str(path.parent), tag["name"]].add(path.name)
    return places


def types(tags):
    """Files that define a type, by (namespace or class, name)."""
    places = collections.defaultdict(set)
    for tag in tags:
        if tag["kind"] in TYPES and "__anon" not in tag.get("scope", "") + tag["name"]:
            places[tag.get("scope", ""), tag["name"]].add(tag["path"])
    return places


def main():
    ctags = shutil.which("ctags")
    if not ctags or "Universal" not in subprocess.run([ctags, "--version"], capture_output=True, text=True).stdout:
        print("skipped: Universal Ctags is absent")
        sys.exit(77)
    sources = sorted(str(path.relative_to(TREE)) for folder in FOLDERS for path in (TREE / folder).rglob("*.[ch]*") if path.suffix in (".h", ".cpp"))
    found = list(tags(sources))
    private, public = private_names(found), types(found)
    faults = 0
    for (folder, name), files in sorted(private.items()):
        if len(files) > 1:
            faults += 1
            print(f"{folder}: '{name}' is defined in {', '.join(sorted(files))}: define it once, or give it two names")
    for (scope, name), files in sorted(public.items()):
        if len(files) > 1:
            faults += 1
            print(f"{scope}::{name} is defined in {', '.join(sorted(files))}: give it one home or two names")
    print(f"{len(private)} names of anonymous namespaces, {len(public)} types, {faults} more than once")
    sys.exit(1 if faults or not private or not public else 0)


if __name__ == "__main__":
    main()
