#!/usr/bin/env python3
"""Checks a report.html by parsers of its own: tags balanced, every picture inside, nothing loaded from elsewhere, every SVG
well-formed XML, the tables' numbers those of summary.json.

usage: check_report.py report.html summary.json
"""

import html.parser
import json
import re
import sys
import xml.etree.ElementTree as xml

VOID = {"meta", "link", "img", "br", "hr", "input", "source", "area", "base", "col", "embed", "track", "wbr"}
# What makes a browser fetch something.
LOADING = {"src", "href", "data", "poster", "srcset", "action", "xlink:href", "background"}


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.faults, self.ids = [], [], []
        self.tables, self.row, self.pictures = [], None, 0

    def handle_starttag(self, tag, attributes):
        self.look(tag, attributes)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.look(tag, attributes)

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        if not self.open or self.open[-1] != tag:
            self.faults.append(f"line {self.getpos()[0]}: </{tag}> inside <{self.open[-1] if self.open else ''}>")
        else:
            self.open.pop()

    def look(self, tag, attributes):
        told = dict(attributes)
        if "id" in told:
            self.ids.append(told["id"])
        if tag == "table":
            self.tables.append((told.get("class", ""), []))
        elif tag == "tr" and self.tables:
            self.tables[-1][1].append([])
        elif tag == "td" and self.tables and "num" in told.get("class", "").split():
            self.tables[-1][1][-1].append(told.get("title"))
        for name, value in attributes:
            if name in LOADING and not re.match(r"(#|data:|blob:)", value or ""):
                self.faults.append(f"line {self.getpos()[0]}: <{tag} {name}=\"{value[:60]}\"> is not inside the page")
            if name == "src" and (value or "").startswith("data:image/png"):
                self.pictures += 1
        if tag == "link":
            self.faults.append("a <link>")


def equal(title, value):
    """A cell's number and the summary's: the same double, or neither measured."""
    return title is None and value is None or title is not None and value is not None and float(title) == float(value)


def check_numbers(page, summary, faults):
    # A requirement with an upper and a lower limit is two criteria of one name, and one row.
    criteria = []
    for criteria_of in [summary] + summary.get("phases", []):
        by_name = {}
        for c in criteria_of.get("criteria", []):
            by_name.setdefault(c["name"], c)
        criteria += by_name.values()
    shown = [row for name, rows in page.tables if name == "criteria" for row in rows if row]
    if [1 for row, c in zip(shown, criteria) if not equal(row[0], c["value"])] or len(shown) != len(criteria):
        faults.append(f"the table of criteria shows {shown}, not {[c['value'] for c in criteria]}")
    metrics = [list(values.values()) for values in summary.get("metrics", {}).values()]
    tables = [[row[0] for row in rows if row] for name, rows in page.tables if name == "metrics"]
    if len(metrics) != len(tables):
        faults.append(f"{len(tables)} tables of metrics, not {len(metrics)}")
    for table, values in zip(tables, metrics):
        if len(table) != len(values) or not all(equal(t, v) for t, v in zip(table, values)):
            faults.append("a table of metrics differs from summary.json")


def main() -> int:
    text = open(sys.argv[1], encoding="utf-8").read()
    summary = json.load(open(sys.argv[2], encoding="utf-8"))
    page = Page()
    page.feed(text)
    page.close()
    faults = page.faults
    if page.open:
        faults.append(f"never closed: {page.open}")
    if len(page.ids) != len(set(page.ids)):
        faults.append(f"ids given twice: {sorted(i for i in set(page.ids) if page.ids.count(i) > 1)}")
    # Outside of scripts, which may name the place of a licence.
    plain = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    for loaded in re.findall(r"(?:url\(|@import)\s*['\"]?(?!data:|#)[^'\")]*", plain):
        faults.append(f"style loads {loaded}")
    count = 0
    for start in re.finditer(r"<svg xmlns=", plain):
        depth, at = 0, start.start()
        for tag in re.finditer(r"<svg[ >]|</svg>", plain[at:]):
            depth += 1 if tag.group().startswith("<svg") else -1
            if depth == 0:
                try:
                    xml.fromstring(plain[at:at + tag.end()])
                except xml.ParseError as error:
                    faults.append(f"an SVG is no XML: {error}")
                count += 1
                break
    check_numbers(page, summary, faults)
    for fault in faults:
        print(fault)
    print(f"{len(text)} bytes, {count} SVGs, {page.pictures} pictures, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
