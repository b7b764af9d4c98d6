"""Sources of the site: every page of docs/, and the README of each folder that pages link to.

docs/index.md is the table of contents. A page in docs/<folder>/ belongs to the section of that name, other pages to the first section that
links to them, all in the order of the links.
"""

import posixpath
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path

from docslib import cpp_pages, parts_pages
from docslib.errors import DocsError
from docslib.headers import copy_headers, public_headers, run_doxygen
from docslib.links import headings, resolved, rewritten, targets, without_comments

INDEX = "docs/index.md"
# READMEs that no section of the index names, nor belong to a README above them, follow this page.
FOLDERS = "docs/architecture.md"


@dataclass
class Section:
    title: str
    pages: list[str] = field(default_factory=list)  # in the repository

    def owns(self, page: str) -> bool:
        return page.startswith(f"docs/{self.title.split()[0].lower()}/")


def site_path(page: str) -> str:
    """Where a page or picture of the repository is on the site."""
    if page.startswith("docs/"):
        return page.removeprefix("docs/")
    folder, name = posixpath.split(page)
    if name == "README.md":
        return f"folders/{folder}.md" if folder else "readme.md"
    return page.lower() if not folder else page


def sections_of(text: str) -> list[Section]:
    pieces = re.split(r"^## ", text, flags=re.MULTILINE)[1:]
    sections = [Section(piece.partition("\n")[0].strip()) for piece in pieces]
    for section, piece in zip(sections, pieces):
        for target in targets(piece, INDEX):
            page = target.partition("#")[0]
            owner = next((other for other in sections if other.owns(page)), section)
            taken = any(page in other.pages for other in sections)
            if page.endswith(".md") and owner is section and not taken:
                section.pages.append(page)
    return sections


class Site:
    def __init__(self, root: Path):
        self.root = root
        self.faults: list[str] = []
        self.texts = self.read_pages()
        self.sections = sections_of(self.texts[INDEX])
        self.headers = public_headers(root)
        self.groups = cpp_pages.groups_of(self.texts[cpp_pages.PAGE], self.headers)
        self.introduction, self.kinds = parts_pages.kinds_of(self.texts[parts_pages.PAGE])
        self.children = self.read_children()

    def read_pages(self) -> dict[str, str]:
        """Pages of docs/, and other Markdown files that they link to, directly or not."""
        texts = {}
        waiting = sorted(path.relative_to(self.root).as_posix() for path in (self.root / "docs").rglob("*.md"))
        while waiting:
            page = waiting.pop(0)
            if page in texts or not (self.root / page).is_file():
                continue
            texts[page] = without_comments((self.root / page).read_text(encoding="utf-8"))
            waiting += [path for path in (target.partition("#")[0] for target in targets(texts[page], page))
                        if path.endswith(".md") and not path.startswith("..")]
        return texts

    def read_children(self) -> dict[str, list[str]]:
        """Page -> pages below it, as paths of the site."""
        children = {parts_pages.PAGE: [kind.page for kind in self.kinds],
                    cpp_pages.PAGE: [f"reference/cpp/{group.name}.md" for group in self.groups]}
        listed = {page for section in self.sections for page in section.pages} | {INDEX}
        for page in self.texts:
            if page in listed:
                continue
            if page.startswith("docs/"):
                self.faults.append(f"{page}: docs/index.md does not link to it in the section of its folder")
                continue
            parent = posixpath.dirname(posixpath.dirname(page))
            while parent and f"{parent}/README.md" not in self.texts:
                parent = posixpath.dirname(parent)
            children.setdefault(f"{parent}/README.md" if parent else FOLDERS, []).append(site_path(page))
        return children

    def target(self, target: str, page: str) -> str:
        """Of a link in a page of the repository: the path on the site; empty if the file is no page."""
        path, _, anchor = resolved(target, page).partition("#")
        mark = f"#{anchor}" if anchor else ""
        if path == parts_pages.PAGE and anchor:
            return parts_pages.anchors(self.kinds).get(anchor, f"reference/parts.md{mark}")
        if path in self.texts:
            return site_path(path) + mark
        if path in self.headers:
            name = self.headers[path]
            group = next(group for group in self.groups if name in group.headers)
            anchor = next(anchor for _, title, anchor in headings(f"## {name}\n"))
            return f"reference/cpp/{group.name}.md#{anchor}"
        for section in self.sections:
            if (self.root / path).is_dir() and section.owns(f"{path}/"):
                anchor = next(anchor for _, title, anchor in headings(self.texts[INDEX]) if title == section.title)
                return f"index.md#{anchor}"
        if not (self.root / path).exists():
            line = self.texts[page].count("\n", 0, self.texts[page].find(f"]({target}")) + 1
            self.faults.append(f"{page}:{line}: {target}: no such file")
        return site_path(path) if path.startswith("docs/pictures/") else ""

    def moved(self, text: str, page: str, place: str) -> str:
        """@param place  of the page on the site"""

        def change(label: str, target: str, image: bool) -> str:
            if target.startswith("#") and page != parts_pages.PAGE:
                return target
            found = self.target(target, page)
            path, mark, anchor = found.partition("#")
            return posixpath.relpath(path, posixpath.dirname(place) or ".") + mark + anchor if found else ""

        return rewritten(text, change)

    def write(self, source: Path, work: Path) -> None:
        """Writes all sources. @throws DocsError with every fault"""
        if source.exists():
            shutil.rmtree(source)
        for page, text in self.texts.items():
            place = site_path(page)
            if page == parts_pages.PAGE:
                text = parts_pages.overview(self.introduction, self.kinds)
            else:
                text = self.moved(text, page, place)
            if page == INDEX:
                text += "".join(toctree(section.title, [site_path(name) for name in section.pages], place)
                                for section in self.sections)
            if page == cpp_pages.PAGE:
                text += "\n{ref}`Index of all names <genindex>`\n"
            text += toctree("", self.children.get(page, []), place)
            write(source / place, text)
        for kind in self.kinds:
            write(source / kind.page, kind.text)
        self.write_cpp(source, work)
        shutil.copytree(self.root / "docs" / "pictures", source / "pictures")
        if self.faults:
            raise DocsError("\n".join(self.faults))

    def write_cpp(self, source: Path, work: Path) -> None:
        shutil.rmtree(work, ignore_errors=True)
        copy_headers(self.root, work / "headers")
        reference = cpp_pages.Reference(run_doxygen(self.root, work / "headers", work))
        for group in self.groups:
            place = f"reference/cpp/{group.name}.md"
            group.text = self.moved(group.text, cpp_pages.PAGE, place)
            write(source / place, cpp_pages.page_text(group, reference))


def toctree(caption: str, pages: list[str], place: str) -> str:
    if not pages:
        return ""
    lines = [posixpath.relpath(page, posixpath.dirname(place) or ".").removesuffix(".md") for page in pages]
    option = f":caption: {caption}\n" if caption else ""
    return "\n".join(["", "```{toctree}", f":hidden:\n{option}", *lines, "```", ""])


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
