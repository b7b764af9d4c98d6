#!/usr/bin/env python3
"""Sources of a folder are compiled together, so a name in an anonymous namespace of one must not stand in another's.

Most such pairs do not compile; two functions of one name and other arguments do, and may then be called for each other. Names
are read by Universal Ctags; without it the test is skipped.
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


def names(sources):
    """(name, source) of what anonymous namespaces hold."""
    command = ["ctags", "--languages=C++", "--kinds-C++=+p", "--fields=+Kst", "--output-format=json", "-o", "-", *sources]
    for line in subprocess.run(command, cwd=TREE, capture_output=True, text=True, check=True).stdout.splitlines():
        tag = json.loads(line)
        if tag.get("_type") != "tag" or tag["kind"] in HARMLESS:
            continue
        if tag.get("scope", "").split("::")[-1].startswith("__anon") and tag.get("scopeKind") == "namespace":
            yield tag["name"], tag["path"]


def main():
    ctags = shutil.which("ctags")
    if not ctags or "Universal" not in subprocess.run([ctags, "--version"], capture_output=True, text=True).stdout:
        print("skipped: Universal Ctags is absent")
        sys.exit(77)
    sources = sorted(str(path.relative_to(TREE)) for folder in FOLDERS for path in (TREE / folder).rglob("*.cpp"))
    places = collections.defaultdict(set)
    for name, path in names(sources):
        places[str(Path(path).parent), name].add(Path(path).name)
    faults = {key: files for key, files in places.items() if len(files) > 1}
    for (folder, name), files in sorted(faults.items()):
        print(f"{folder}: '{name}' stands in {', '.join(sorted(files))}: give it one home or two names")
    print(f"{len(places)} names of anonymous namespaces, {len(faults)} more than once in their folder")
    sys.exit(1 if faults or not places else 0)


if __name__ == "__main__":
    main()
