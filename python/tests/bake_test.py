"""Bakes through Python: the bits of the command line, arrays without copies, progress, Ctrl-C."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import lobelia

COMMAND = os.environ["LOBELIA_COMMAND"]
SMALL = {"size": (64, 64), "samples": 16}


class Bakes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = lobelia.embedded_scene("cornell")
        cls.progress = []
        cls.bake = lobelia.bake(cls.scene, **SMALL, progress=cls.progress.append)

    def test_gives_the_bits_of_the_command_line(self):
        with tempfile.TemporaryDirectory() as folder:
            options = "--size 64x64 --samples 16 --precision float --storage none --no-page".split()
            subprocess.run([COMMAND, "bake", "cornell", "-o", folder, *options], check=True, capture_output=True)
            theirs = lobelia.read_bake(folder)
        self.assertEqual(len(theirs.pages), len(self.bake.pages))
        for ours, other in zip(self.bake.pages, theirs.pages):
            self.assertEqual(ours.channels, other.channels)
            for channel in ours.channels:
                np.testing.assert_array_equal(ours[channel], other[channel], channel)
            np.testing.assert_array_equal(ours.chart, other.chart)

    def test_pages_are_views(self):
        page = self.bake.pages[0]
        self.assertEqual((page.width, page.height), (64, 64))
        first = page["c0.G"]
        self.assertEqual(first.shape, (64, 64))
        self.assertEqual(first.ctypes.data, page["c0.G"].ctypes.data)
        self.assertFalse(first.flags.owndata)
        self.assertFalse(first.flags.writeable)
        self.assertEqual(page.normals.shape, (64, 64, 3))
        with self.assertRaises(KeyError):
            page["c99.G"]

    def test_views_outlive_the_bake(self):
        E = lobelia.bake(self.scene, size=(32, 32), samples=16, codec="").pages[0]["E.G"]
        self.assertGreater(E.max(), 0)

    def test_coefficients_evaluate_to_the_irradiance_of_the_paths(self):
        page, codec = self.bake.pages[0], lobelia.Codec(self.bake.codec)
        lit = page.chart > 0
        E, normals = page.irradiance, page.normals
        c = page.coefficients
        self.assertEqual(c.shape, (64, 64, codec.size, 3))
        ours = np.stack([codec.irradiance(c[y, x], normals[y, x]) for y, x in np.argwhere(lit)[::50]])
        theirs = E[lit][::50]
        self.assertLess(np.sqrt(((ours - theirs) ** 2).mean()), 0.35 * theirs.mean())

    def test_progress_and_statistics(self):
        self.assertTrue(all(0 <= p.done <= 1 and p.stage == "texels" for p in self.progress))
        self.assertGreater(self.bake.statistics["texels"], 1000)
        self.assertEqual(self.bake.statistics["samples"], 16)
        self.assertEqual(self.bake.objects, self.scene.objects)

    def test_writes_what_it_reads(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder) / "out"
            self.bake.write(folder, storages=[], scene=self.scene)
            self.assertTrue((folder / "bake.json").is_file())
            there = lobelia.read_bake(folder)
            np.testing.assert_allclose(there.pages[0]["c0.R"], self.bake.pages[0]["c0.R"], rtol=1e-3, atol=1e-4)

    def test_bad_options_are_errors(self):
        for options in ({"samples": 0}, {"size": (0, 64)}, {"bounces": 65}, {"codec": "sh2"}, {"frame": "moon"},
                        {"storages": ["no-such"]}, {"container": "no-such"}, {"memory": 1}):
            with self.assertRaises(lobelia.Error, msg=str(options)):
                lobelia.bake(self.scene, **{**SMALL, **options})
        with self.assertRaises(TypeError):
            lobelia.bake(self.scene, sample=16)


class Stops(unittest.TestCase):
    """Bakes that would take hours end soon, on a busy machine, too."""

    LONG = {"size": (512, 512), "samples": 100000}

    def test_exception_in_progress(self):
        class Enough(Exception):
            pass

        def progress(_):
            raise Enough

        with self.assertRaises(Enough):
            lobelia.bake(lobelia.embedded_scene("cornell"), size=(128, 128), samples=100000, progress=progress)

    def test_keyboard_interrupt(self):
        timer = threading.Timer(0.7, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            lobelia.bake(lobelia.embedded_scene("cornell"), **self.LONG)
        self.assertLess(time.monotonic() - begin, 60)

    def test_other_threads_run_meanwhile(self):
        ticks = []
        done = threading.Event()

        def tick():
            while not done.wait(0.01):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        lobelia.bake(lobelia.embedded_scene("cornell"), size=(128, 128), samples=64)
        done.set()
        thread.join()
        self.assertGreater(len(ticks), 3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
