"""Checks that script/notebook converts a page to a notebook with the page's cells in their order."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from page import ROOT, Page  # noqa: E402

TUTORIAL = ROOT / "docs" / "tutorial_python.md"


def notebook_of(page):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "out.ipynb"
        subprocess.run([sys.executable, ROOT / "script" / "notebook", page, path], check=True)
        return json.loads(path.read_text())


class Notebook(unittest.TestCase):
    def test_has_the_cells_of_the_tutorial(self):
        made = notebook_of(TUTORIAL)
        cells = [block.text.rstrip("\n") for block in Page(TUTORIAL).blocks if block.info == "python cell"]
        outputs = [block.text for block in Page(TUTORIAL).blocks if block.info == "text output"]
        code = [cell for cell in made["cells"] if cell["cell_type"] == "code"]
        self.assertEqual([cell["source"] for cell in code], cells)
        self.assertEqual([out["text"] for cell in code for out in cell["outputs"]], outputs)
        self.assertGreater(len(cells), 5)
        words = "\n".join(cell["source"] for cell in made["cells"] if cell["cell_type"] == "markdown")
        for line in (text for _, text in Page(TUTORIAL).prose):
            self.assertIn(line, words)
        self.assertIn("    script/notebook", words)  # blocks of other kinds are text
        self.assertEqual(len({cell["id"] for cell in made["cells"]}), len(made["cells"]))

    def test_is_one_for_nbformat(self):
        try:
            import nbformat
        except ImportError:
            self.skipTest("no nbformat (Debian: python3-nbformat)")
        nbformat.validate(nbformat.from_dict(notebook_of(TUTORIAL)))


if __name__ == "__main__":
    unittest.main()
