"""Public headers as an installed package has them, and what Doxygen reads from them."""

import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from docslib.errors import DocsError

COMMENT = re.compile(r"^(\s*)///(?!<)(.*)$")


def places(root: Path) -> dict[str, str]:
    """Folder or file of the repository -> its name in the package, from cmake/install_headers.cmake."""
    text = (root / "cmake" / "install_headers.cmake").read_text(encoding="utf-8")
    lists = [re.search(rf"^set\({name} ([^)]*)\)", text, re.MULTILINE) for name in ("places", "installed_as")]
    if not all(lists):
        raise DocsError("cmake/install_headers.cmake: the lists 'places' and 'installed_as' are missing")
    return dict(zip(*(found.group(1).split() for found in lists)))


def public_headers(root: Path) -> dict[str, str]:
    """Path in the repository -> path in the package."""
    found = {}
    for place, name in places(root).items():
        if (root / place).is_file():
            found[place] = name
        else:
            for header in sorted((root / place).rglob("*.h")):
                found[header.relative_to(root).as_posix()] = f"{name}/{header.relative_to(root / place).as_posix()}"
    return found


def for_doxygen(text: str) -> str:
    """The first comment describes the file; indented lines after an empty one are code."""
    lines, result, code, first = text.split("\n"), [], False, True
    for number, line in enumerate(lines):
        found = COMMENT.match(line)
        after_empty = number > 0 and lines[number - 1].strip() == "///"
        indented = bool(found) and found.group(2).startswith("   ") and (code or after_empty)
        between = code and bool(found) and not found.group(2).strip() and number + 1 < len(lines) and \
            re.match(r"\s*///   ", lines[number + 1]) is not None
        if found and first and number < 2:
            result.append("/// @file")
        first = first and not found
        if indented and not code:
            result.append(f"{found.group(1)}/// @code{{.cpp}}")
            code = True
        elif code and not indented and not between:
            result.append(re.match(r"\s*", lines[number - 1]).group(0) + "/// @endcode")
            code = False
        result.append(line)
    return "\n".join(result)


def copy_headers(root: Path, target: Path) -> None:
    names = places(root)
    for source, name in public_headers(root).items():
        text = (root / source).read_text(encoding="utf-8")
        for place, installed in names.items():
            text = text.replace(place, installed)
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_text(for_doxygen(text), encoding="utf-8")


def run_doxygen(root: Path, headers: Path, out: Path) -> Path:
    """docs/Doxyfile, but of the copied headers and as XML. @returns the folder of the XML."""
    settings = (root / "docs" / "Doxyfile").read_text(encoding="utf-8") + f"""
INPUT = {headers}
STRIP_FROM_PATH = {headers}
OUTPUT_DIRECTORY = {out}
GENERATE_HTML = NO
GENERATE_XML = YES
"""
    done = subprocess.run(["doxygen", "-"], input=settings, text=True, capture_output=True)
    if done.returncode != 0 or "warning:" in done.stderr:
        raise DocsError(f"doxygen: {done.stderr.strip()}")
    return out / "xml"


def compounds(xml: Path) -> list[ElementTree.Element]:
    index = ElementTree.parse(xml / "index.xml").getroot()
    return [compound for entry in index for compound in ElementTree.parse(xml / f"{entry.get('refid')}.xml").getroot()]
