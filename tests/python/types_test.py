#!/usr/bin/env python3
"""Types of the Python package: the stubs of the extension module are up to date, and mypy accepts package and guide.

    types_test.py      (in the environment of tools/python_environment)
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(os.environ["PYTHONPATH"]).resolve()  # the built one
STUBS = ROOT / "python" / "vinerow" / "_core.pyi"


class Types(unittest.TestCase):
    def python(self, *arguments: object, folder: pathlib.Path = ROOT) -> str:
        """Runs a module; its output. Fails if the exit status is not 0."""
        with tempfile.TemporaryDirectory() as cache:
            done = subprocess.run([sys.executable, "-B", "-m", *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                                  env={**os.environ, "MYPYPATH": str(PACKAGE), "MYPY_CACHE_DIR": cache})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_the_stubs_are_up_to_date(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([ROOT / "tools" / "python_stubs", folder], check=True)
            made = (pathlib.Path(folder) / "_core.pyi").read_text()
        self.assertEqual(STUBS.read_text(), made, "run tools/python_stubs")

    def test_the_stubs_have_every_name_of_the_module(self):
        with tempfile.TemporaryDirectory() as folder:
            allowed = pathlib.Path(folder) / "allowed"
            # pybind11's metaclass, and the constructors of classes that Python cannot construct.
            allowed.write_text(r"vinerow\._core\.[A-Z]\w*(\.__init__)?")
            self.python("mypy.stubtest", "--allowlist", allowed, "--ignore-unused-allowlist", "vinerow._core")

    def test_the_package_is_strict(self):
        self.python("mypy", "--strict", "--package", "vinerow")

    def test_the_examples_of_the_guide_are_strict(self):
        text = (ROOT / "docs" / "guides" / "python.md").read_text()
        examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        self.assertGreater(len(examples), 2)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "examples.py"
            for example in examples:
                file.write_text("import vinerow\n" + example)
                self.python("mypy", "--strict", file, folder=pathlib.Path(folder))
            file.write_text('import vinerow\nvinerow.open("x.yaml").step("soon")\n')
            with self.assertRaisesRegex(AssertionError, 'Argument 1 to "step" of "Session" has incompatible type "str"'):
                self.python("mypy", "--strict", file, folder=pathlib.Path(folder))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
