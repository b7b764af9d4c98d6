#!/usr/bin/env python3
"""Opens a run's report in Chromium, as a stranger would from disk: it must render without an error on its console, and its
first screen must show the verdict. Exit status 77: there is no Chromium.

usage: report_in_browser.py VINEROW SCENARIO FOLDER
"""

import pathlib
import re
import shutil
import struct
import subprocess
import sys
import zlib

WIDTH, HEIGHT = 1280, 900
# The soft green of a verdict that is met (tools/vinerow/report/page_style.cpp).
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


def open_in(browser: str, page: pathlib.Path, folder: pathlib.Path, shot: pathlib.Path) -> subprocess.CompletedProcess:
    """Opens a page as from disk, without a graphics card, and takes a screenshot."""
    return subprocess.run(
        [browser, "--headless", "--no-sandbox", "--hide-scrollbars", "--enable-logging=stderr", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", f"--user-data-dir={folder / 'profile'}", f"--window-size={WIDTH},{HEIGHT}",
         f"--screenshot={shot}", page.resolve().as_uri()],
        capture_output=True, text=True, timeout=240)


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
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults, first screen in {shot}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
