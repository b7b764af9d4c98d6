#!/usr/bin/env python3
"""The examples of docs/guides/python.md run as they are written, in its order.

    guide_test.py VINEROW ...
"""

import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
VINEROW = sys.argv[1]


class Guide(unittest.TestCase):
    def test_examples(self):
        text = (ROOT / "docs" / "guides" / "python.md").read_text()
        examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertEqual(len(examples), 4)
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            os.symlink(ROOT / "assets", "assets")
            os.symlink(ROOT / "docs" / "examples" / "session" / "free_rover.yaml", "free_rover.yaml")
            subprocess.run([VINEROW, "run", "free_rover.yaml", "--quiet", "--no-pictures", "--no-report", "--out", "runs/demo"],
                           check=True, capture_output=True)
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                names = {}
                for example in examples:
                    exec(compile(example, "docs/guides/python.md", "exec"), names)
            os.chdir(ROOT)
        lines = printed.getvalue().splitlines()
        self.assertRegex(lines[0], r"^\{.*'distance_m': .*\} [0-9a-f]{32}$")
        self.assertRegex(lines[1], r"^\((\d+),\) \(\1, 3\)$")
        self.assertEqual(lines[2], "True all criteria met 5.0")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
