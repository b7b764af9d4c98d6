#!/usr/bin/env python3
"""The installed headers are a closed set: what one includes is installed with it, or C++, or Eigen.

  installed_headers.py INCLUDE_DIR SOURCE_FILE

Writes SOURCE_FILE, which includes every one of them, for a compiler to try.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
# Headers of the language have no slash and no suffix.
FROM_OUTSIDE = re.compile(r"[a-z_0-9]+|Eigen/[A-Za-z]+")
TOP = {"api", "core", "math", "sim", "session.h", "testing.h", "version.h"}
OF_SESSIONS = ["vinerow/sim/session.h"]


def main() -> int:
    root, source = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    installed = sorted(path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file())
    faults = []
    for name in installed:
        if not name.endswith(".h") or name.split("/")[0] != "vinerow" or name.split("/")[1] not in TOP:
            faults.append(f"{name} is installed and no public header")
        if name.startswith("vinerow/sim/") and name not in OF_SESSIONS:
            faults.append(f"{name} is installed and private")
        for ours, outside in INCLUDE.findall((root / name).read_text(encoding="utf-8")):
            if ours and ours not in installed:
                faults.append(f'{name} includes "{ours}", which is not installed')
            if outside and outside not in installed and not FROM_OUTSIDE.fullmatch(outside):
                faults.append(f"{name} includes <{outside}>, which users need not have")
    for must in ("api/plugin.h", "core/error.h", "math/pose.h", "session.h", "testing.h", "version.h"):
        if f"vinerow/{must}" not in installed:
            faults.append(f"vinerow/{must} is not installed")
    for fault in faults:
        print(fault)
    source.write_text("".join(f"#include <{name}>\n" for name in installed), encoding="utf-8")
    print(f"{len(installed)} installed headers, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
