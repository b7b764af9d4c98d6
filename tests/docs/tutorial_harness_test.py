#!/usr/bin/env python3
"""The test of the tutorial's pages itself: pages that are right pass, pages that are wrong fail and say where.

    tutorial_harness_test.py VINEROW
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

HARNESS = pathlib.Path(__file__).with_name("tutorial_test.py")
VINEROW = sys.argv[1]


def run(page: str, *options: str) -> tuple[int, str]:
    """@returns exit status and what it printed; with --update the page instead"""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "page.md"
        file.write_text(page)
        result = subprocess.run([sys.executable, "-B", HARNESS, VINEROW, file, *options],
                                capture_output=True, encoding="utf-8")  # fmt: skip
        return result.returncode, file.read_text() if "--update" in options else result.stdout + result.stderr


def console(*lines: str) -> str:
    return "\n".join(["Words.", "", "```console", *lines, "```", ""])


class Pages(unittest.TestCase):
    def passes(self, page: str):
        status, text = run(page)
        self.assertEqual(status, 0, text)

    def fails(self, page: str, *says: str):
        status, text = run(page)
        self.assertEqual(status, 1, text)
        for part in says:
            self.assertIn(part, text)

    def test_output_is_compared_line_by_line(self):
        self.passes(console("$ printf 'one\\ntwo\\n'", "one", "two"))
        self.fails(console("$ printf 'one\\ntwo\\nthree\\n'", "one", "zwei", "three"),
                   "page.md:4: $ printf", "      one\n    - zwei\n    + two\n      three")  # fmt: skip
        self.fails(console("$ printf 'one\\ntwo\\n'", "one"), "+ two")
        self.fails(console("$ echo one", "one", "two"), "- two")

    def test_dots_stand_for_lines_and_for_text(self):
        self.passes(console("$ seq 9", "1", "...", "8", "9"))
        self.passes(console("$ seq 3", "1", "2", "...", "3"))
        self.passes(console("$ seq 3", "..."))
        self.passes(console("$ echo took 12.5 s in all", "took ... s in all"))
        self.fails(console("$ echo took 12.5 s", "took ... min"), "- took ... min", "+ took 12.5 s")
        self.fails(console("$ seq 9", "1", "...", "7", "9"), "+ 8")

    def test_an_exit_status_is_shown(self):
        self.passes(console("$ (exit 2)", "$ echo $?", "2"))
        self.fails(console("$ (exit 2)", "$ echo $?", "0"), "- 0", "+ 2")
        self.fails(console("$ echo so; (exit 2)", "so"), "exit status 2")

    def test_files_are_written_and_commands_share_a_shell(self):
        page = "```yaml file=a/b.yaml\nkey: 1\n```\n" + console("$ cat a/b.yaml", "key: 1", "$ cd a", "$ ls", "b.yaml")
        self.passes(page)
        self.passes(console("$ export WORD=x", "$ echo $WORD \\", "    y", "x y", "$ printf 'it'\"'\"'s'", "it's"))
        self.fails("```yaml file=../b.yaml\nkey: 1\n```\n" + console("$ true"), "not inside")

    def test_the_folder_looks_like_the_project(self):
        self.passes(console("$ vinerow --version", "...", "$ ls assets/scenarios/riseholme_rover.yaml",
                            "assets/scenarios/riseholme_rover.yaml", "$ ls build/release/bin/vinerow",
                            "build/release/bin/vinerow"))  # fmt: skip

    def test_update_writes_what_differs(self):
        old = console("$ seq 9", "1", "...", "7", "9", "", "$ echo b", "a") + "\nEnd.\n"
        new = console("$ seq 9", "1", "...", "7", "8", "9", "", "$ echo b", "b") + "\nEnd.\n"
        self.assertEqual(run(old, "--update")[1], new)
        self.assertEqual(run(new, "--update"), (0, new))

    def test_what_is_not_run(self):
        self.passes("```console no-test\n$ false\n```\n```yaml\nkey: 1\n```\n" + console("$ true"))
        self.fails("```console no-test\n$ false\n```\n", "no command")
        self.fails("```console\n$ true\n", "no end")

    def test_what_a_page_needs(self):
        status, text = run("<!-- needs: bash, no_such_program, python3:no_such_module -->\n" + console("$ true"))
        self.assertEqual((status, text), (77, "skipped: no_such_program, python3:no_such_module absent\n"))
        self.passes("<!-- needs: bash, python3:json -->\n" + console("$ true"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
