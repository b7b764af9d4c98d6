"""Links of Markdown: where they are, and what they become when pages move."""

import posixpath
import re
from collections.abc import Callable

# Code is left alone: fenced blocks, then code spans.
CODE = re.compile(r"(^ *(`{3,}|~{3,})[^\n]*\n.*?^ *\2`*~* *$|(?<!`)(`+)(?!`).+?(?<!`)\3(?!`))", re.DOTALL | re.MULTILINE)
# The text of a link may contain code spans and an image.
LINK = re.compile(r"(!?)\[((?:[^\[\]]|!?\[[^\[\]]*\](?:\([^()]*\))?)*)\]\(([^()\s]+)((?:\s+\"[^\"]*\")?)\)")
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
EXTERNAL = re.compile(r"^[a-z][a-z0-9+.-]*:")
HEADING = re.compile(r"^(#{1,6}) +(.+?) *#* *$", re.MULTILINE)


def hidden(text: str) -> tuple[str, list[str]]:
    """The text with each piece of code replaced by a mark, and the pieces."""
    kept = []

    def keep(found: re.Match) -> str:
        kept.append(found.group(0))
        return f"\x00{len(kept) - 1}\x00"

    return CODE.sub(keep, text), kept


def shown(text: str, kept: list[str]) -> str:
    return re.sub("\x00(\\d+)\x00", lambda found: kept[int(found.group(1))], text)


def without_comments(text: str) -> str:
    text, kept = hidden(text)
    return shown(COMMENT.sub("", text), kept)


def slug(heading: str) -> str:
    """Anchor of a heading, as GitHub and MyST make it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def headings(text: str) -> list[tuple[int, str, str]]:
    """Level, text and anchor of each heading."""
    text, kept = hidden(text)
    seen, found = {}, []
    for level, title in HEADING.findall(text):
        title = shown(title, kept)
        anchor = slug(re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title))
        count = seen[anchor] = seen.get(anchor, -1) + 1
        found.append((len(level), title, f"{anchor}-{count}" if count else anchor))
    return found


def targets(text: str, file: str) -> list[str]:
    """What a file of the repository links to: paths in the repository with anchors, without external links."""
    plain, _ = hidden(text)
    found = [target for _, _, target, _ in LINK.findall(plain)]
    # An image inside a link's text.
    found += [inner for _, label, _, _ in LINK.findall(plain) for _, _, inner, _ in LINK.findall(label)]
    return [resolved(target, file) for target in found if not EXTERNAL.match(target)]


def resolved(target: str, file: str) -> str:
    path, mark, anchor = target.partition("#")
    path = posixpath.normpath(posixpath.join(posixpath.dirname(file), path)) if path else file
    return path + mark + anchor


def rewritten(text: str, change: Callable[[str, str, bool], str]) -> str:
    """@param change  (text, target, whether an image) of each link that is not external -> what replaces the link"""
    text, kept = hidden(text)

    def replace(found: re.Match) -> str:
        mark, label, target, title = found.groups()
        if EXTERNAL.match(target):
            return found.group(0)
        label = LINK.sub(replace, label)
        changed = change(label, target, bool(mark))
        return f"{mark}[{label}]({changed}{title})" if changed else label

    return shown(LINK.sub(replace, text), kept)
