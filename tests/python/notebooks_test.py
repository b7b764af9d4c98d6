#!/usr/bin/env python3
"""The notebooks of docs/examples/notebooks are committed without outputs, and run from the first cell to the last.

    notebooks_test.py [NOTEBOOK...]     (in the environment of tools/python_environment)
"""

import os
import pathlib
import sys
import tempfile
import unittest

import nbclient
import nbformat

import vinerow

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "examples" / "notebooks"
NAMES = sys.argv[1:] or ["plot_a_run", "tune_a_gain", "train_ppo"]


def executed(name: str) -> nbformat.NotebookNode:
    """The notebook after its run, in a folder with the same place relative to the scenarios."""
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    with tempfile.TemporaryDirectory() as root:
        folder = pathlib.Path(root) / "docs" / "examples" / "notebooks"
        folder.mkdir(parents=True)
        (pathlib.Path(root) / "assets").symlink_to(ROOT / "assets")
        nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


def outputs(notebook: nbformat.NotebookNode) -> list:
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def texts(notebook: nbformat.NotebookNode) -> str:
    return "".join(output.text for output in outputs(notebook) if output.output_type == "stream" and output.name == "stdout")


def count(notebook: nbformat.NotebookNode, kind: str) -> int:
    return sum(kind in output.get("data", {}) for output in outputs(notebook))


class Notebooks(unittest.TestCase):
    def test_they_are_committed_without_outputs(self):
        for file in FOLDER.glob("*.ipynb"):
            notebook = nbformat.read(file, as_version=4)
            nbformat.validate(notebook)
            self.assertEqual(outputs(notebook), [], file)
            self.assertTrue(all(cell.execution_count is None for cell in notebook.cells if cell.cell_type == "code"), file)

    @unittest.skipUnless("plot_a_run" in NAMES, "not asked for")
    def test_plot_a_run(self):
        notebook = executed("plot_a_run")
        self.assertEqual(count(notebook, "image/png"), 3)  # two plots and a drawn picture
        shown = " ".join(output.data["text/html"] for output in outputs(notebook) if "text/html" in output.get("data", {}))
        self.assertIn("all criteria met", shown)
        self.assertIn("top_000090000", shown)
        with vinerow.open(ROOT / "assets" / "scenarios" / "riseholme_rover.yaml", {"duration_s": 90}) as session:
            follower, largest_m = session.signal("rover/follower"), 0.0
            while not session.over:  # the controller's period
                session.step_for(0.025)
                largest_m = max(largest_m, abs(follower["lateral_error"]))
        self.assertIn(f"largest lateral error {100 * largest_m:.1f} cm", texts(notebook))

    @unittest.skipUnless("tune_a_gain" in NAMES, "not asked for")
    def test_tune_a_gain(self):
        notebook = executed("tune_a_gain")
        self.assertEqual(count(notebook, "image/png"), 1)
        lookahead_m = float(texts(notebook).split("lookahead ")[1].split(" m:")[0])
        self.assertTrue(0.4 < lookahead_m < 1.5, lookahead_m)

    @unittest.skipUnless("train_ppo" in NAMES, "not asked for")
    def test_train_ppo(self):
        notebook = executed("train_ppo")
        self.assertEqual(count(notebook, "image/png"), 2)
        returns = [float(line.split("return ")[1]) for line in texts(notebook).splitlines() if "return " in line]
        self.assertEqual(len(returns), 4)
        # Standing still gives the price of 10 cm, -0.5 a step; driving on the line gives nearly 1 a step.
        self.assertGreater(returns[-1], 50.0)
        self.assertGreater(returns[-1], returns[0] + 50.0)
        self.assertIn("reached the end: True", texts(notebook))


if __name__ == "__main__":
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    unittest.main(argv=sys.argv[:1])
