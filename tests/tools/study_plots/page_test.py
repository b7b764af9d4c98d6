#!/usr/bin/env python3
"""The sample page of a study's plots and its plots as files of their own: each is well formed to a parser of XML that others wrote.

usage: page_test.py STUDY_PLOTS_SAMPLE FOLDER
"""

import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

SVG = "{http://www.w3.org/2000/svg}svg"


def main() -> int:
    sample, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([sample, folder], check=True)
    page = xml.parse(folder / "sample.html").getroot()
    figures = page.findall(".//figure")
    faults = [] if figures else ["the page has no figures"]
    for figure in figures:
        if not figure.findtext("h4") or len(figure.findall(f".//{SVG}")) != 1:
            faults.append(f"a figure without a title, or without its picture: {figure.findtext('h4')}")
    files = sorted(folder.glob("*.svg"))
    if len(files) != len(figures):
        faults.append(f"{len(files)} files of {len(figures)} figures")
    for file in files:
        if xml.parse(file).getroot().tag != SVG:
            faults.append(f"{file.name} is no SVG")
    for fault in faults:
        print(fault)
    print(f"{len(figures)} figures, {len(files)} files, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
