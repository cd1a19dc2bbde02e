#!/usr/bin/python3
"""Pictures of runs: from a folder as the tool draws them, and of runs in this process."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import matplotlib

matplotlib.use("Agg")

import fmbpc  # noqa: E402
from fmbpc import plots  # noqa: E402


class Plots(unittest.TestCase):
    def test_a_run_is_drawn_with_a_panel_of_each_signal(self):
        run = fmbpc.Loop("asp_case1", set={"sampling.duration_h": 4}).run()
        axes = run.plot().axes
        self.assertGreaterEqual(len(axes), len(run.outputs) + len(run.inputs))
        self.assertEqual(len(run.time), len(axes[0].lines[-1].get_xdata()))
        with tempfile.TemporaryDirectory() as folder:
            run.save(folder)
            self.assertEqual(len(axes), len(plots.run_picture([folder]).axes))

    def test_what_the_page_and_the_help_show_runs(self):
        """The blocks of docs/python.md, and the lines of help(fmbpc), one after the other."""
        page = (pathlib.Path(__file__).resolve().parents[2] / "docs/python.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", page, flags=re.S)
        blocks.append("\n".join(line.strip() for line in fmbpc.__doc__.splitlines() if line.startswith("    ")))
        self.assertTrue(all("import fmbpc" in block for block in blocks) and len(blocks) > 1)
        with tempfile.TemporaryDirectory() as folder:
            for block in blocks:
                subprocess.run([sys.executable, "-c", block], check=True, cwd=folder, env={**os.environ, "MPLBACKEND": "Agg"})
            self.assertTrue(pathlib.Path(folder, "run.png").exists())

    def test_what_cannot_be_drawn_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            for words, code in (([], 2), (["cake", folder], 2), (["run", folder], 1), (["model", folder], 1), (["reproduce", folder], 1)):
                done = subprocess.run([sys.executable, "-m", "fmbpc.plots", *words], capture_output=True, check=False)
                self.assertEqual((code, True), (done.returncode, bool(done.stderr)), words)

    def test_the_tool_draws_by_it(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["FMBPC_TOOL"], "run", "asp_case1", "--set", "sampling.duration_h=4", "--out", folder], check=True, capture_output=True)
            self.assertTrue(pathlib.Path(folder, "plot.png").exists())


if __name__ == "__main__":
    unittest.main()
