#!/usr/bin/python3
"""The notebooks run, cell by cell."""
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parents[2] / "examples/notebooks").glob("*.ipynb"))


class Notebooks(unittest.TestCase):
    def test_all_run(self):
        self.assertEqual(5, len(NOTEBOOKS))
        with tempfile.TemporaryDirectory() as folder:
            def run(notebook):
                words = [sys.executable, "-m", "jupyter", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, str(notebook),
                         "--ExecutePreprocessor.timeout=300"]
                return notebook.name, subprocess.run(words, capture_output=True, text=True, check=False, cwd=folder,
                                                     env={**os.environ, "IPYTHONDIR": folder, "JUPYTER_RUNTIME_DIR": folder})
            with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
                for name, done in pool.map(run, NOTEBOOKS):
                    with self.subTest(name):
                        self.assertEqual(0, done.returncode, done.stderr[-3000:])


if __name__ == "__main__":
    unittest.main()
