"""The lines of Python in docs/gallery.md run, and the notebooks run cell by cell."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
import warnings
from pathlib import Path

import asperity as asp

ROOT = Path(__file__).parent.parent.parent


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        warnings.simplefilter("ignore", asp.PremiseWarning)

    def test_lines_of_the_gallery_run(self):
        shutil.copytree(ROOT / "docs" / "examples", Path("docs") / "examples")
        subprocess.run(["sh", "docs/examples/map.sh"], check=True)
        page = (ROOT / "docs" / "gallery.md").read_text()
        lines = [part.split("```")[0].strip() for part in page.split("```python\n")[1:]]
        self.assertEqual(len(lines), 11)
        for line in lines:
            with self.subTest(line):
                self.assertIsNotNone(eval(line, {"asp": asp}))

    def test_notebooks_run(self):
        for notebook in sorted((ROOT / "docs" / "notebooks").glob("*.ipynb")):
            with self.subTest(notebook.name):
                names = {}
                for cell in json.loads(notebook.read_text())["cells"]:
                    if cell["cell_type"] == "code":
                        exec("".join(cell["source"]), names)


if __name__ == "__main__":
    unittest.main()
