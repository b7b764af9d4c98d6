"""Check of a built site: every link and anchor leads somewhere, nothing comes from the network."""

import os
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag

EXTERNAL = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)
LOADED = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("video", "src"),
          ("object", "data")}


class Page(HTMLParser):
    """Anchors and links of a page."""

    def __init__(self, text: str):
        super().__init__(convert_charrefs=True)
        self.anchors: set[str] = set()
        self.links: list[tuple[str, bool]] = []  # target, whether the page loads it
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name == "id" or (tag, name) == ("a", "name"):
                self.anchors.add(value or "")
            elif (tag, name) in LOADED or (tag, name) == ("a", "href"):
                self.links.append((value or "", tag != "a"))


def read_site(site: Path) -> dict[Path, Page]:
    return {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}


def faults_of(site: Path) -> list[str]:
    """A line for each fault."""
    site = site.resolve()
    pages, faults = read_site(site), []
    for path, page in pages.items():
        name = path.relative_to(site)
        for link, loaded in page.links:
            if EXTERNAL.match(link):
                if loaded and not link.startswith("data:"):
                    faults.append(f"{name}: loads {link} from elsewhere")
                continue
            target, anchor = urldefrag(link)
            file = Path(os.path.normpath(path.parent / unquote(target.partition("?")[0]))) if target else path
            if not file.is_file():
                faults.append(f"{name}: {link}: no such file")
            elif anchor and file in pages and unquote(anchor) not in pages[file].anchors:
                faults.append(f"{name}: {link}: no such anchor")
    for style in sorted(site.rglob("*.css")):
        for link in re.findall(r"url\(\s*['\"]?([^'\")]+)|@import\s+['\"]([^'\"]+)", style.read_text(encoding="utf-8")):
            target = link[0] or link[1]
            if not target.startswith("data:") and (target.startswith("/") or not (style.parent / target).is_file()):
                faults.append(f"{style.relative_to(site)}: loads {target} from elsewhere")
    for script in sorted(site.rglob("*.js")):
        for name in re.findall(r"^import .*", script.read_text(encoding="utf-8"), re.MULTILINE):
            faults.append(f"{script.relative_to(site)}: {name}: browsers load no modules from files")
    for path in sorted(site.rglob("*")):
        if path.is_symlink():
            faults.append(f"{path.relative_to(site)}: a link to {os.readlink(path)}")
    return faults


def reachable(site: Path) -> set[str]:
    """Pages that links lead to from index.html, as paths in the site."""
    site = site.resolve()
    pages = read_site(site)
    found, waiting = set(), [site / "index.html"]
    while waiting:
        path = waiting.pop()
        if path in found or path not in pages:
            continue
        found.add(path)
        for link, loaded in pages[path].links:
            target = urldefrag(link)[0]
            if target and not loaded and not EXTERNAL.match(target):
                waiting.append(Path(os.path.normpath(path.parent / unquote(target))))
    return {path.relative_to(site).as_posix() for path in found}
