#!/usr/bin/env python3
"""Is the documentation site built without a warning, complete and searchable, and does its check notice faults?

    site_test.py OUT     OUT: folder for the site. Exit status 77 if packages are missing.
"""

import html
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))

from docslib import built, cpp_pages, headers, links, pages, parts_pages, theme  # noqa: E402
from docslib.errors import DocsError  # noqa: E402

COMMAND = [sys.executable, "-B", str(ROOT / "tools" / "docs")]
OUT = Path(sys.argv.pop()) if len(sys.argv) > 1 else ROOT / "build" / "docs"


class BuiltSite(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.done = subprocess.run([*COMMAND, "--out", str(OUT)], capture_output=True, text=True)

    def setUp(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)

    @staticmethod
    def text(page: str) -> str:
        return html.unescape(re.sub(r"<[^>]*>", "", (OUT / page).read_text(encoding="utf-8")))

    def test_has_no_warnings(self):
        self.assertEqual(self.done.stderr, "")
        self.assertEqual(self.done.stdout.strip(), str(OUT.resolve() / "index.html"))

    def test_every_page_of_docs_is_reachable_from_the_index(self):
        expected = {path.relative_to(ROOT / "docs").with_suffix(".html").as_posix() for path in (ROOT / "docs").rglob("*.md")}
        self.assertGreater(len(expected), 40)
        self.assertEqual(expected - built.reachable(OUT), set())

    def test_has_a_search_index_with_words_and_names(self):
        index = (OUT / "searchindex.js").read_text(encoding="utf-8")
        self.assertTrue(index.startswith("Search.setIndex("))
        for word in ("headland", "advance_for", "four_wheel_steering"):
            self.assertIn(word, index)

    def test_interface_has_the_class_session_with_its_description(self):
        header = (ROOT / "engine" / "sim" / "session.h").read_text(encoding="utf-8")
        comment = re.search(r"  /// ([^\n.]*)[^\n]*\n(?:  ///[^\n]*\n)*  void reset\(std::uint64_t seed\);", header).group(1)
        text = self.text("reference/cpp/session.html")
        for part in ("class Session", "#include <vinerow/sim/session.h>", "void reset(std::uint64_t seed)", comment):
            self.assertTrue(part in text, part)
        self.assertNotIn("impl_", text)
        self.assertIn('id="_CPPv4N7vinerow7SessionE"', (OUT / "reference/cpp/session.html").read_text(encoding="utf-8"))

    def test_interface_has_every_public_header_under_its_installed_name(self):
        text = "".join(self.text(f"reference/cpp/{path.name}") for path in (OUT / "reference" / "cpp").glob("*.html"))
        for name in headers.public_headers(ROOT).values():
            self.assertEqual(text.count(f"#include <{name}>\n"), 1, name)
        self.assertNotRegex(text, r"\bengine/(api|core|math|sim/session)")

    def test_parts_have_a_page_for_each_kind(self):
        self.assertIn("air_data", self.text("reference/parts/sensor.html"))
        self.assertNotIn("min_airspeed_mps", self.text("reference/parts.html"))

    def test_works_without_a_network(self):
        self.assertEqual(built.faults_of(OUT), [])


class Faults(unittest.TestCase):
    def site(self, changes: dict[str, str]) -> pages.Site:
        original = pages.Site.read_pages

        def changed(site):
            texts = original(site)
            return texts | {page: texts.get(page, "") + text for page, text in changes.items()}

        pages.Site.read_pages = changed
        self.addCleanup(setattr, pages.Site, "read_pages", original)
        return pages.Site(ROOT)

    def test_a_page_that_the_index_does_not_name_is_an_error(self):
        self.assertIn("docs/guides/lost.md: docs/index.md does not link to it in the section of its folder",
                      self.site({"docs/guides/lost.md": "# Lost\n"}).faults)

    def test_a_link_to_a_missing_file_is_an_error_with_its_line(self):
        site = self.site({"docs/glossary.md": ""})
        site.texts["docs/glossary.md"] = "# A\n\n`[x](code.md)` and [x](guides/nowhere.md#here)\n"
        site.moved(site.texts["docs/glossary.md"], "docs/glossary.md", "glossary.md")
        self.assertEqual([fault for fault in site.faults if "glossary" in fault],
                         ["docs/glossary.md:3: guides/nowhere.md#here: no such file"])

    def test_a_header_must_be_listed_once_under_its_installed_name(self):
        row = "| [`vinerow/a.h`](../../engine/a.h) | a |\n"
        known = {"engine/a.h": "vinerow/a.h"}
        self.assertEqual(cpp_pages.groups_of(f"## One\n\nText.\n\n{row}", known)[0].headers, ["vinerow/a.h"])
        for page, known, fault in ((f"## One\n{row}{row}", known, "twice"), ("## One\n", known, "missing"),
                                   (f"## One\n{row}", {"engine/a.h": "vinerow/api/a.h"}, "installed name")):
            with self.assertRaisesRegex(DocsError, fault):
                cpp_pages.groups_of(page, known)

    def test_built_pages_with_dead_links_or_links_to_the_network(self):
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder)
            (site / "a.html").write_text('<a href="b.html#here"></a><a href="c.html"></a><a href="#top"></a><a href="https://x.org"></a>'
                                         '<script src="https://x.org/x.js"></script>')
            (site / "b.html").write_text('<p id="there"><a href="a.html">a</a>')
            (site / "a.css").write_text("@import url(/javascript/x.css);")
            (site / "a.js").write_text('import X from "./x.js";\n')
            self.assertEqual(built.faults_of(site), [
                "a.html: b.html#here: no such anchor", "a.html: c.html: no such file", "a.html: #top: no such anchor",
                "a.html: loads https://x.org/x.js from elsewhere", "a.css: loads /javascript/x.css from elsewhere",
                'a.js: import X from "./x.js";: browsers load no modules from files'])

    def test_a_folder_that_is_no_site_is_not_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "mine").write_text("x")
            done = subprocess.run([*COMMAND, "--out", folder], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (1, f"docs: --out {folder}: not empty, and not a site\n"))
            self.assertTrue((Path(folder) / "mine").exists())


class Pieces(unittest.TestCase):
    def test_sections_own_the_pages_of_their_folder(self):
        sections = pages.sections_of("# D\n\n## Start\n\n[a](guides/a.md) [g](glossary.md)\n\n## Guides\n\n[b](guides/b.md#x) [a](guides/a.md)\n"
                                     "\n## Other\n\n[g](glossary.md) [r](../x/README.md)\n")
        self.assertEqual([section.pages for section in sections],
                         [["docs/glossary.md"], ["docs/guides/b.md", "docs/guides/a.md"], ["x/README.md"]])

    def test_links_change_outside_code_only(self):
        text = "[a](b.md#c) `[a](b.md)` [![p](q.png)](b.md) [e](https://x.org)\n\n```cpp\nf = [](int) {}; [a](b.md)\n```\n"
        self.assertEqual(links.rewritten(text, lambda label, target, image: "" if image else f"n/{target}"),
                         "[a](n/b.md#c) `[a](b.md)` [p](n/b.md) [e](https://x.org)\n\n```cpp\nf = [](int) {}; [a](b.md)\n```\n")

    def test_anchors_are_those_of_github(self):
        self.assertEqual([anchor for _, _, anchor in links.headings("# A, b: `c_d`\n## x\n```\n# no\n```\n## x\n")], ["a-b-c_d", "x", "x-1"])

    def test_parts_are_split_by_kind_with_their_anchors(self):
        introduction, kinds = parts_pages.kinds_of("# Parts\n\nText.\n\n## Kind: map\n\n### map `a_b`\n\nwords\n\n## Kind: job\n\n### job `c`\n")
        self.assertEqual(introduction, "# Parts\n\nText.\n\n")
        self.assertEqual(parts_pages.anchors(kinds), {"kind-map": "reference/parts/map.md", "kind-job": "reference/parts/job.md",
                                                      "map-a_b": "reference/parts/map.md#map-a_b", "job-c": "reference/parts/job.md#job-c"})
        self.assertIn("\n## map `a_b`\n\nwords\n", kinds[0].text)

    def test_indented_comments_are_code(self):
        self.assertEqual(headers.for_doxygen("#pragma once\n/// A file:\n///\n///   int a;\n///\n///   int b;\n///\n/// Text.\nint c;"),
                         "#pragma once\n/// @file\n/// A file:\n///\n/// @code{.cpp}\n///   int a;\n///\n///   int b;\n/// @endcode\n"
                         "///\n/// Text.\nint c;")

    def test_a_theme_in_pieces_is_completed(self):
        with tempfile.TemporaryDirectory() as folder:
            static = Path(folder)
            (static / "styles").mkdir()
            (static / "scripts").mkdir()
            (static / "styles" / "furo.css").write_text("p {}\n")
            (static / "scripts" / "part.js").write_text("part();\n")
            (static / "scripts" / "furo.js").write_text('import Part from "./part.js";\n\nmain();\n')
            theme.complete(static)
            self.assertEqual((static / "styles" / "furo.css").read_text(), "p {}\n")
            self.assertEqual((static / "scripts" / "furo.js").read_text(), "part();\n\nmain();\n")


if __name__ == "__main__":
    missing = subprocess.run([*COMMAND, "--missing"], capture_output=True, text=True, check=True).stdout.split()
    if missing:
        print(f"skipped, missing packages: {', '.join(missing)}")
        sys.exit(77)
    unittest.main()
