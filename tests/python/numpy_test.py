#!/usr/bin/env python3
"""A build with a pybind11 that does not know NumPy 2 refuses it, instead of reading its arrays wrongly.

    numpy_test.py
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest


class NumPyOfAnotherKind(unittest.TestCase):
    def import_with(self, version):
        """What an import prints if NumPy says that it is this version."""
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "numpy"
            package.mkdir()
            (package / "__init__.py").write_text(f"__version__ = {version!r}\n")
            path = os.pathsep.join([folder, os.environ["PYTHONPATH"]])
            done = subprocess.run([sys.executable, "-c", "import vinerow._core"], capture_output=True, text=True,
                                  env={**os.environ, "PYTHONPATH": path})
            return done.returncode, done.stderr.strip().splitlines()[-1]

    def test_numpy_2_is_refused(self):
        status, last = self.import_with("2.1.3")
        self.assertEqual(status, 1)
        self.assertEqual(last, "ImportError: this build of vinerow needs NumPy 1, but this is NumPy 2.1.3: install 'numpy<2', "
                               "or build vinerow with pybind11 2.12 or later, as 'pip install .' does")

    def test_the_systems_numpy_is_fine(self):
        subprocess.run([sys.executable, "-c", "import vinerow"], check=True)


if __name__ == "__main__":
    unittest.main()
