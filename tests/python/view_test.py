"""`taut.Run.save` writes what `taut run` writes; `taut.view` shows the page of `taut report`."""

import html
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest
from unittest import mock

import taut
from helpers import COMMAND, MASS, PUSH, main


def short_push():
    experiment = taut.load(PUSH)
    experiment.duration_s = 0.2
    return experiment


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name):
        return str(self.folder / name)


class Saved(Folder):
    def test_a_run_equals_one_of_the_command(self):
        ran = taut.run(short_push())
        ran.save(self.path("ours"))
        subprocess.run([COMMAND, "run", PUSH, "--duration_s", "0.2", "--quiet", "--out", self.path("theirs")], check=True)
        ours, theirs = taut.read_trace(self.path("ours")), taut.read_trace(self.path("theirs"))
        self.assertEqual(ours.channels, theirs.channels)
        self.assertEqual(ours.units, theirs.units)
        self.assertFalse(ours.unfinished)
        for name in ours.channels:
            self.assertEqual(ours[name].tobytes(), theirs[name].tobytes(), name)
        once = {"run": "", "started": ""}  # differ between any two runs
        self.assertEqual({**ours.metadata, **once}, {**theirs.metadata, **once})
        texts = [(self.folder / who / "inputs.yaml").read_text().split("\n", 1) for who in ("ours", "theirs")]
        self.assertEqual(texts[0][1], texts[1][1])
        summaries = [json.loads((self.folder / who / "summary.json").read_text()) for who in ("ours", "theirs")]
        self.assertEqual(summaries[0]["run"], ours.metadata["run"])
        for summary in summaries:
            for key in ("run", "wall_s", "real_time_factor"):
                summary.pop(key, None)
        self.assertEqual(*summaries)

    def test_a_run_is_the_one_that_was_made(self):
        experiment = short_push()
        ran = taut.run(experiment)
        experiment.duration_s = 7
        ran.save(self.path("a"))
        self.assertRegex((self.folder / "a/inputs.yaml").read_text(), r"duration_s: 0\.2\b")

    def test_an_earlier_run_is_replaced(self):
        taut.run(short_push()).save(self.path("a"))
        longer = short_push()
        longer.duration_s = 0.3
        taut.run(longer).save(self.path("a"))
        self.assertAlmostEqual(taut.read_trace(self.path("a")).time_s[-1], 0.3)
        self.assertEqual(sorted(os.listdir(self.path("a"))), [".lock", "inputs.yaml", "summary.json", "trace.h5"])

    def test_a_folder_that_cannot_be_created_raises(self):
        (self.folder / "file").write_text("")
        with self.assertRaisesRegex(taut.InputError, "file"):
            taut.run(short_push()).save(self.path("file/a"))


class Viewed(Folder):
    def setUp(self):
        super().setUp()
        self.ran = taut.run(short_push())
        try:
            self.view = taut.view(self.ran)
        except RuntimeError as error:
            if "pages" not in str(error):
                raise
            self.skipTest("the viewer's pages are not built")

    def test_a_run_in_memory_has_a_page(self):
        self.assertIn("push_20n", self.view.html)
        self.view.save(self.path("page.html"))
        self.assertEqual((self.folder / "page.html").read_text(encoding="utf-8"), self.view.html)

    def test_a_cell_contains_the_page_in_any_encoding(self):
        cell = self.view._repr_html_()
        self.assertTrue(cell.isascii())
        inside = re.search(r'srcdoc="([^"]*)"', cell)[1]
        self.assertEqual(html.unescape(inside), self.view.html)
        self.assertIn("height:720px", cell)

    def test_saved_runs_and_ghosts(self):
        self.ran.save(self.folder / "a")
        alone = taut.view(pathlib.Path(self.path("a")))
        both = taut.view(self.path("a"), [self.ran])
        self.assertGreater(len(both.html), len(alone.html))
        self.assertGreater(len(taut.view(self.path("a"), self.ran).html), len(alone.html))

    def test_wrong_arguments_raise(self):
        with self.assertRaisesRegex(TypeError, "run: 3; expected a taut.Run, or the path"):
            taut.view(3)
        with self.assertRaisesRegex(TypeError, r"compare\[0\]: 3"):
            taut.view(self.ran, [3])
        for height in (True, 99, 1e3, "720"):
            with self.assertRaisesRegex(ValueError, "height_px: .*; expected a whole number, 100 to 10000"):
                taut.view(self.ran, height_px=height)
        with self.assertRaisesRegex(RuntimeError, "nothing: error: cannot open"):
            taut.view(self.path("nothing"))
        with self.assertRaisesRegex(RuntimeError, "taut.view: "):
            taut.view(MASS)

    def test_an_absent_command_is_named(self):
        with mock.patch("taut._view._core") as core, mock.patch("shutil.which", return_value=None):
            core.__file__ = self.path("python/taut/_core.so")
            del core.main
            with self.assertRaisesRegex(FileNotFoundError, "needs the command `taut`"):
                taut.view(self.ran)

    def test_show_opens_a_browser(self):
        with mock.patch("webbrowser.open") as opened:
            path = self.view.show()
        self.addCleanup(os.remove, path)
        opened.assert_called_once_with(pathlib.Path(path).as_uri())
        self.assertEqual(pathlib.Path(path).read_text(encoding="utf-8"), self.view.html)


if __name__ == "__main__":
    main()
