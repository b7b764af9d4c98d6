#!/usr/bin/env python3
"""Opens a run's report in Chromium, as a stranger would from disk: it must render without an error on its console, its first
screen must show the verdict, on a telephone nothing may reach beyond the window, every event of the run must be listed, and a
picture must open over the page. Exit status 77: there is no Chromium.

usage: report_in_browser.py VINEROW SCENARIO FOLDER
"""

import html.parser
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import zlib

WIDTH, HEIGHT = 1280, 900
TELEPHONES = (390, 500)
# The soft green of a verdict that is met (tools/report/page_style.cpp).
GREEN = (0xE6, 0xF1, 0xE2)
ERRORS = re.compile(r"CONSOLE.*(Uncaught|SyntaxError|TypeError|ReferenceError|Failed to load|net::ERR|Refused)")


def read_png(file: pathlib.Path) -> list[list[tuple[int, int, int]]]:
    """Rows of 8-bit RGB or RGBA pixels (PNG specification, sections 7 and 9), as the browser writes them."""
    data, at, packed = file.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and colour in (2, 6), "an unusual PNG"
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    size, raw, before, rows = 3 if colour == 2 else 4, zlib.decompress(packed), None, []
    stride = width * size
    before = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = line[i - size] if i >= size else 0
            up, corner = before[i], before[i - size] if i >= size else 0
            if kind == 1:
                line[i] = (line[i] + left) & 255
            elif kind == 2:
                line[i] = (line[i] + up) & 255
            elif kind == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif kind == 4:
                p = left + up - corner
                nearest = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
                line[i] = (line[i] + nearest) & 255
        rows.append([tuple(line[x * size:x * size + 3]) for x in range(width)])
        before = line
    return rows


def open_in(browser: str, page: pathlib.Path, folder: pathlib.Path, shot: pathlib.Path,
            size: tuple[int, int] = (WIDTH, HEIGHT)) -> subprocess.CompletedProcess:
    """Opens a page as from disk, without a graphics card, and takes a screenshot."""
    return subprocess.run(
        [browser, "--headless", "--no-sandbox", "--hide-scrollbars", "--enable-logging=stderr", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", f"--user-data-dir={folder / 'profile'}", f"--window-size={size[0]},{size[1]}",
         f"--screenshot={shot}", page.resolve().as_uri()],
        capture_output=True, text=True, timeout=240)


# Measures what only a browser knows of the page; events fire as after a click of a user.
TRIAL = """<script>(function () {
  const root = document.documentElement, told = {width: root.scrollWidth, window: window.innerWidth};
  const wide = [...document.querySelectorAll('body *')].filter((e) => {
    if (e.closest('.scroll, .wide-chart, nav, dialog, .vinerow-replay') || e.ownerSVGElement) return false;
    return e.getBoundingClientRect().right > window.innerWidth + 0.5;
  });
  told.beyond = wide.slice(0, 5).map((e) => e.outerHTML.slice(0, 80));
  const image = document.querySelector('figure.picture img, figure.opens img');
  if (image) {
    const dialog = document.querySelector('dialog.picture');
    image.click();
    told.opens = dialog.open && dialog.querySelector('img').src === image.src && dialog.getBoundingClientRect().width >= window.innerWidth;
    dialog.querySelector('img').click();
    told.closes = !dialog.open;
  }
  told.broken = [...document.querySelectorAll('td, th, summary')].map((cell) => {
    const words = document.createRange();
    words.selectNodeContents(cell);
    const lines = cell.children.length ? 1 : words.getClientRects().length;
    return /^\\w{1,10}$/.test(cell.textContent) && lines > 1 ? cell.textContent : '';
  }).filter((word) => word);
  const slider = document.querySelector('.vr-slider');
  if (slider) told.slider = slider.clientWidth;
  console.log('TRIAL ' + JSON.stringify(told) + ' END');
}());</script>
"""


def try_page(browser: str, page: pathlib.Path, folder: pathlib.Path, width: int) -> dict:
    """Result of TRIAL for a page of this width: inside a frame, as Chromium opens no window narrower than 500 pixels."""
    text, trial = page.read_text(encoding="utf-8"), folder / f"trial_{width}_{page.name}"
    end = text.rindex("</body>")
    trial.write_text(text[:end] + TRIAL + text[end:], encoding="utf-8")
    outer = folder / f"frame_{width}_{page.name}"
    outer.write_text(f'<!DOCTYPE html><html><body><iframe src="{trial.name}" width="{width}" height="844" style="border:0">'
                     "</iframe></body></html>", encoding="utf-8")
    told = open_in(browser, outer, folder, outer.with_suffix(".png"))
    found = re.search(r'"TRIAL (.*) END"', told.stderr)
    return json.loads(found.group(1)) if found else {}


def document_of(browser: str, page: pathlib.Path, folder: pathlib.Path) -> str:
    """The document as the browser holds it."""
    return subprocess.run(
        [browser, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         f"--user-data-dir={folder / 'profile'}", "--dump-dom", page.resolve().as_uri()],
        capture_output=True, text=True, timeout=240).stdout


class EventTable(html.parser.HTMLParser):
    """Texts of the cells of table.events."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.inside, self.text = False, ""

    def handle_starttag(self, tag, attributes):
        if tag == "table":
            self.inside = "events" in (dict(attributes).get("class") or "").split()

    def handle_endtag(self, tag):
        if tag == "table":
            self.inside = False

    def handle_data(self, data):
        if self.inside:
            self.text += data


def telephone_faults(browser: str, page: pathlib.Path, folder: pathlib.Path) -> list[str]:
    faults = []
    for width in TELEPHONES:
        told = try_page(browser, page, folder, width)
        if told.get("window") != width:
            faults.append(f"{page.name}: the window is {told.get('window')} wide, not {width}")
        elif told.get("slider", width) < 0.7 * width:
            faults.append(f"{page.name}: the replay's slider is {told['slider']} px long in a window of {width}")
        elif told["width"] > width:
            faults.append(f"{page.name} is {told['width']} px wide in a window of {width}: {told['beyond']}")
        elif told["beyond"] or told["broken"]:
            faults.append(f"{page} in a window of {width}: beyond it {told['beyond']}, broken words {told['broken']}")
    return faults


LONG_NAMES = """
vinerow: 1
duration_s: 1
world: {type: orchard}
vehicles:
  a_very_long_name_of_the_only_rover_of_a_careful_farmer_in_burgundy:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 2}
    planner: {type: coverage}
    controller: {type: path_follower, rate_Hz: 40}
criteria:
  - {metric: a_very_long_name_of_the_only_rover_of_a_careful_farmer_in_burgundy.distance_m, min: 100}
"""


def long_names_page(vinerow: str, folder: pathlib.Path) -> pathlib.Path:
    """Report of a failed run whose names are wider than a telephone."""
    scenario = folder / "long_names.yaml"
    scenario.write_text(LONG_NAMES, encoding="utf-8")
    subprocess.run([vinerow, "run", scenario, "--quiet", "--no-pictures", "--out", folder / "long_names"])
    return folder / "long_names" / "report.html"


def event_faults(run: pathlib.Path, document: str) -> list[str]:
    table = EventTable()
    table.feed(document)
    events = [json.loads(line) for line in (run / "events.jsonl").read_text(encoding="utf-8").splitlines()]
    faults = [] if events else ["the run has no events, so they cannot be looked for"]
    faults += [f"the page does not show the event '{e['text']}'" for e in events if e["text"] not in table.text]
    return faults + [f"the page does not show {e['source']} as the source of an event" for e in events if e["source"] not in table.text]


def main() -> int:
    vinerow, scenario, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    browser = next((b for b in ("chromium", "chromium-browser", "google-chrome") if shutil.which(b)), None)
    if browser is None:
        print("skipped: Chromium is absent (Debian: chromium)")
        return 77
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    run = folder / "run"
    subprocess.run([vinerow, "run", scenario, "--quiet", "--no-pictures", "--no-report", "--out", run], check=True)
    # One frame: a picture of 2 x 2 pixels, as a PNG file by the standard.
    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    (run / "frames").mkdir(exist_ok=True)
    (run / "frames" / "camera_000001000.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(b"\0" + bytes([200, 40, 40] * 2) + b"\0" + bytes([40, 40, 200] * 2))) + chunk(b"IEND", b""))
    subprocess.run([vinerow, "report", run], check=True)
    shot = folder / "first_screen.png"
    try:
        told = open_in(browser, run / "report.html", folder, shot)
    except subprocess.TimeoutExpired:
        print("skipped: Chromium did not draw the page within 240 s on this machine")
        return 77
    faults = [line for line in told.stderr.splitlines() if ERRORS.search(line)]
    if not shot.is_file():
        faults.append("no screenshot:\n" + told.stderr[-2000:])
    else:
        rows = read_png(shot)
        pixels = [pixel for row in rows[::4] for pixel in row[::4]]
        colours = {}
        for pixel in pixels:
            colours[pixel] = colours.get(pixel, 0) + 1
        if (len(rows[0]), len(rows)) != (WIDTH, HEIGHT):
            faults.append(f"the screenshot has {len(rows[0])} x {len(rows)} pixels")
        if len(colours) < 60 or max(colours.values()) > 0.9 * len(pixels):
            faults.append(f"the first screen is nearly blank: {len(colours)} colours")
        if colours.get(GREEN, 0) < 0.02 * len(pixels):
            faults.append("the first screen shows no verdict")
    try:
        faults += telephone_faults(browser, run / "report.html", folder)
        faults += telephone_faults(browser, long_names_page(vinerow, folder), folder)
        if subprocess.run([vinerow, "replay", run]).returncode == 0:
            faults += telephone_faults(browser, run / "replay.html", folder)
        told = try_page(browser, run / "report.html", folder, WIDTH)
        faults += event_faults(run, document_of(browser, run / "report.html", folder))
        if not (told.get("opens") and told.get("closes")):
            faults.append(f"a picture does not open over the page and close again: {told}")
    except subprocess.TimeoutExpired:
        faults.append("Chromium did not lay out the page within 240 s")
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults, first screen in {shot}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
