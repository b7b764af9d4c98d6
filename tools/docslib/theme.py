"""Completes the theme of Debian 12, whose parts are files of their own.

The style sheet imports normalize.css by an absolute path, and the script imports another one as a module: neither works for pages that are
opened as files. A theme that has its parts inside stays as it is.
"""

import re
from pathlib import Path

IMPORTED_STYLE = re.compile(r"@import url\((/javascript/[^)]+)\);\n?")
IMPORTED_SCRIPT = re.compile(r"^import \w+ from \"\./([^\"]+)\";\n", re.MULTILINE)


def complete(static: Path) -> None:
    style = static / "styles" / "furo.css"
    style.write_text(IMPORTED_STYLE.sub(lambda found: Path(f"/usr/share{found.group(1)}").read_text(encoding="utf-8"),
                                        style.read_text(encoding="utf-8")), encoding="utf-8")
    script = static / "scripts" / "furo.js"
    text = script.read_text(encoding="utf-8")
    parts = [(script.parent / name).read_text(encoding="utf-8") for name in IMPORTED_SCRIPT.findall(text)]
    script.write_text("".join(parts) + IMPORTED_SCRIPT.sub("", text), encoding="utf-8")
