"""docs/reference/parts.md is one page of all parts; the site has a page for each kind."""

import re
from dataclasses import dataclass

from docslib.links import headings

PAGE = "docs/reference/parts.md"


@dataclass
class Kind:
    name: str
    text: str
    parts: list[tuple[str, str]]  # name, anchor

    @property
    def page(self) -> str:
        return f"reference/parts/{self.name}.md"


def kinds_of(text: str) -> tuple[str, list[Kind]]:
    """The introduction, and each kind."""
    introduction, *sections = re.split(r"^## Kind: ", text, flags=re.MULTILINE)
    kinds = []
    for section in sections:
        name, _, body = section.partition("\n")
        name = name.strip()
        found = headings(body)
        parts = [(re.sub(r"^\w+ ", "", title), anchor) for level, title, anchor in found if level == 3]
        body = re.sub(r"^###", "##", body, flags=re.MULTILINE)
        # The page of a kind is one folder deeper.
        body = re.sub(r"\]\((?=[\w-]+\.md)", "](../", body)
        kinds.append(Kind(name, f"# Parts: {name}\n\n[All parts and the notation](../parts.md)\n{body}", parts))
    return introduction, kinds


def overview(introduction: str, kinds: list[Kind]) -> str:
    rows = [f"| [{kind.name}](parts/{kind.name}.md) | " +
            ", ".join(f"[{name}](parts/{kind.name}.md#{anchor})" for name, anchor in kind.parts) + " |"
            for kind in kinds]
    return "\n".join([introduction.rstrip(), "", "| kind | parts |", "|---|---|", *rows, ""])


def anchors(kinds: list[Kind]) -> dict[str, str]:
    """Anchor in the one page -> page of the site with its anchor."""
    found = {f"kind-{kind.name}": kind.page for kind in kinds}
    for kind in kinds:
        found |= {anchor: f"{kind.page}#{anchor}" for _, anchor in kind.parts}
    return found
