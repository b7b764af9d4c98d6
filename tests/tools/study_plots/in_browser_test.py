#!/usr/bin/env python3
"""Opens the sample page of a study's plots in Chromium: a click or Enter on a mark must show the command of its cell, arrows must go
from mark to mark, nothing may reach beyond a telephone's window, no text of a plot may be smaller than 9 pixels there, and the
console must show no error. Exit status 77: there is no Chromium.

usage: in_browser_test.py STUDY_PLOTS_SAMPLE FOLDER
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

ERRORS = re.compile(r"CONSOLE.*(Uncaught|SyntaxError|TypeError|ReferenceError|Failed to load|net::ERR|Refused)")
WIDTHS = (390, 1280)

# Events fire as a user's would make them.
TRIAL = """<script>(function () {
  const told = {window: window.innerWidth, width: document.documentElement.scrollWidth};
  const panel = document.querySelector('.command-panel'), code = panel.querySelector('code');
  told.hidden = panel.hidden;
  const press = (element, key) => element.dispatchEvent(new KeyboardEvent('keydown', {key: key, bubbles: true}));
  told.commands = [...document.querySelectorAll('svg.study')].map((svg) => {
    const mark = svg.querySelector('[data-cell]');
    if (!mark) return null;
    mark.dispatchEvent(new MouseEvent('click', {bubbles: true}));
    return [mark.dataset.cell, code.textContent, panel.hidden];
  });
  told.about = panel.querySelector('.about').textContent;
  press(document.body, 'Escape');
  told.closed = panel.hidden;
  const marks = document.querySelector('svg.study').querySelectorAll('[data-cell]');
  marks[0].focus();
  press(marks[0], 'ArrowRight');
  told.focused = document.activeElement === marks[1];
  press(marks[1], 'Enter');
  told.entered = [marks[1].dataset.cell, code.textContent];
  told.stops = [...document.querySelectorAll('svg.study')].map((svg) => svg.querySelectorAll('[tabindex="0"]').length);
  const sizes = [...document.querySelectorAll('svg.study text')].map((text) => {
    const svg = text.ownerSVGElement;
    return parseFloat(getComputedStyle(text).fontSize) * svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
  });
  told.smallest = Math.min(...sizes);
  told.largest = Math.max(...sizes);
  console.log('TRIAL ' + JSON.stringify(told) + ' END');
}());</script>
"""


def tell(browser: str, page: pathlib.Path, folder: pathlib.Path, width: int) -> tuple[dict, list[str]]:
    """Result of TRIAL for a window of this width: inside a frame, as Chromium opens none narrower than 500 pixels."""
    text, trial, outer = page.read_text(encoding="utf-8"), folder / f"trial_{width}.html", folder / f"frame_{width}.html"
    end = text.rindex("</body>")
    trial.write_text(text[:end] + TRIAL + text[end:], encoding="utf-8")
    outer.write_text(f'<!DOCTYPE html><html><body style="margin:0"><iframe src="{trial.name}" width="{width}" height="844" '
                     'style="border:0"></iframe></body></html>', encoding="utf-8")
    log = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--hide-scrollbars", "--enable-logging=stderr", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", f"--user-data-dir={folder / 'profile'}", f"--window-size={max(width, 500)},844",
         f"--screenshot={folder / f'page_{width}.png'}", outer.resolve().as_uri()],
        capture_output=True, text=True, timeout=240).stderr
    found = re.search(r'"TRIAL (.*) END"', log)
    return json.loads(found.group(1)) if found else {}, [line for line in log.splitlines() if ERRORS.search(line)]


def faults_of(told: dict, width: int) -> list[str]:
    if not told:
        return ["the page told nothing"]
    faults = []
    if not told["hidden"]:
        faults.append("the panel is there before a click")
    for number, command in enumerate(told["commands"]):
        if command and (command[1] != f"vinerow study cell study.yaml {command[0]}" or command[2]):
            faults.append(f"plot {number}: a click on cell {command[0]} shows '{command[1]}'")
    if sum(command is not None for command in told["commands"]) < 12:
        faults.append("few plots have cells")
    if "cell" not in told["about"]:
        faults.append(f"the panel shows the cell: '{told['about']}'")
    if not told["closed"]:
        faults.append("Escape leaves the panel open")
    if not told["focused"] or told["entered"][1] != f"vinerow study cell study.yaml {told['entered'][0]}":
        faults.append(f"keys do not reach the next mark: {told['entered']}")
    if max(told["stops"]) > 1:
        faults.append(f"the Tab key stops more than once in a plot: {told['stops']}")
    if told["window"] != width or told["width"] > width:
        faults.append(f"the page is {told['width']} px wide in a window of {told['window']}")
    if told["smallest"] < 8.6 or told["largest"] > 17.0:
        faults.append(f"texts of {told['smallest']:.1f} to {told['largest']:.1f} px")
    return [f"{width} px: {fault}" for fault in faults]


def main() -> int:
    sample, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    browser = next((b for b in ("chromium", "chromium-browser", "google-chrome") if shutil.which(b)), None)
    if browser is None:
        print("skipped: Chromium is absent (Debian: chromium)")
        return 77
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([sample, folder], check=True)
    faults = []
    try:
        for width in WIDTHS:
            told, errors = tell(browser, folder / "sample.html", folder, width)
            faults += errors + faults_of(told, width)
    except subprocess.TimeoutExpired:
        print("skipped: Chromium did not draw the page within 240 s on this machine")
        return 77
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
