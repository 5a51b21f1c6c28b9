"""`sim.show()` and `batch.show()`: a browser sees the states of a program that neither waits nor changes."""

import base64
import contextlib
import gc
import json
import math
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request
from unittest import mock

import taut
from helpers import MASS, PRISM, PUSH, interrupted, main

TIME, NOW, RUN, BODIES, HEADER = 0, 1, 9, 10, 19  # places in a frame (web/protocol/messages.json)


class Browser:
    """WebSocket client of a page."""

    def __init__(self, url):
        address, _, token = url.removeprefix("http://").partition("/?token=")
        host, _, port = address.partition(":")
        self.socket = socket.create_connection((host, int(port)), timeout=20)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /ws?token={token} HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.file = self.socket.makefile("rb")
        assert b" 101 " in self.file.readline()
        while self.file.readline() != b"\r\n":
            pass

    def close(self):
        self.file.close()
        self.socket.close()

    def send(self, **message):
        data, key = json.dumps(message).encode(), os.urandom(4)
        assert len(data) < 126
        self.socket.sendall(bytes([0x81, 0x80 | len(data)]) + key + bytes(byte ^ key[i % 4] for i, byte in enumerate(data)))

    def read(self):
        """Returns the next message: a dict, a frame as a tuple of numbers, or nothing at the end of the connection."""
        data, kind = b"", 0
        while True:
            head = self.file.read(2)
            if len(head) < 2 or head[0] & 15 == 8:
                return None
            length = head[1] & 127
            if length >= 126:
                size = 2 if length == 126 else 8
                length = int.from_bytes(self.file.read(size), "big")
            kind = head[0] & 15 or kind
            data += self.file.read(length)
            if head[0] & 128:
                return json.loads(data) if kind == 1 else struct.unpack(f"<{len(data) // 8}d", data)

    def message(self, kind):
        while True:
            got = self.read()
            if got is None:
                raise AssertionError(f"the connection ended without a message {kind}")
            if isinstance(got, dict) and got["type"] == kind:
                return got

    def frame(self, wanted):
        """Returns the first frame for which `wanted` is true."""
        limit = time.monotonic() + 20
        while time.monotonic() < limit:
            got = self.read()
            if got is None:
                raise AssertionError("the connection ended without the frame")
            if isinstance(got, tuple) and wanted(got):
                return got
        raise AssertionError("no such frame within 20 s")


class Live(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        (pathlib.Path(folder.name) / "index.html").write_text("<p>the page")
        pages = mock.patch.dict(os.environ, TAUT_WEB=folder.name)
        pages.start()
        self.addCleanup(pages.stop)

    def show(self, what, **options):
        view = what.show(browser=False, **options)
        self.addCleanup(view.close)
        return view

    def browser(self, view):
        browser = Browser(view.url)
        self.addCleanup(browser.close)
        return browser

    def closes(self, browser):
        with contextlib.suppress(ConnectionError):
            while browser.read() is not None:
                pass

    # --- states in a browser ----------------------------------------------------------------------------------------
    def test_the_state_is_seen_before_and_after_each_call(self):
        sim = taut.Simulation(PUSH)
        browser = self.browser(self.show(sim))
        self.assertEqual(browser.message("hello")["mode"], "program")
        scene = browser.message("scene")["scene"]
        self.assertEqual([body["name"] for body in scene["bodies"]], sim.bodies)
        self.assertTrue(any(cable.get("tags") for cable in scene["cables"]))
        self.assertTrue(scene["phases"])
        browser.frame(lambda frame: frame[TIME] == 0)
        for _ in range(3):
            sim.step(7)
            frame = browser.frame(lambda frame: frame[TIME] == sim.time_s()[0])
            self.assertEqual(frame[HEADER:HEADER + 3], tuple(sim.body_position_m()[0, 0]))
            at = HEADER + 7 * int(frame[BODIES])
            self.assertEqual(frame[at], sim.tension_n()[0, 0])
            self.assertFalse(math.isnan(frame[at + 3]))  # set point of its impedance control
        run = frame[RUN]
        sim.reset()
        self.assertGreater(browser.frame(lambda frame: frame[TIME] == 0)[RUN], run)

    def test_a_long_call_is_seen_while_it_runs(self):
        for what, step in ((taut.Simulation(PUSH), lambda sim: sim.run_until(1e5)),
                           (taut.Batch(taut.load(PUSH).robot), lambda batch: batch.step(1e-3, 1 << 30))):
            with self.subTest(type(what).__name__):
                browser = self.browser(self.show(what))
                seen = []

                def look():
                    seen.extend(browser.frame(lambda frame: frame[TIME] > at)[TIME] for at in (0, 0.5, 1))

                thread = threading.Thread(target=look)
                thread.start()
                interrupted(self, lambda: step(what))
                thread.join()
                self.assertEqual(len(seen), 3)

    def test_at_most_60_states_per_second_are_sent(self):
        sim = taut.Simulation(PUSH)
        browser = self.browser(self.show(sim))
        end = time.monotonic() + 2
        while time.monotonic() < end:
            sim.step()
        last_s = sim.time_s()[0]
        times = set()
        browser.frame(lambda frame: times.add(frame[TIME]) or frame[TIME] == last_s)
        self.assertLess(len(times), 2 * 60 + 5)
        self.assertGreater(len(times), 2)

    def test_a_browser_holds_the_picture_while_the_program_goes_on(self):
        sim = taut.Simulation(PUSH)
        browser = self.browser(self.show(sim))
        for time_s in (0.1, 0.2, 0.3):
            sim.run_until(time_s)
            browser.frame(lambda frame: frame[TIME] == sim.time_s()[0])
        at_s = sim.time_s()[0]
        browser.send(type="seek", time_s=0.1)
        held_s = browser.frame(lambda frame: frame[TIME] < frame[NOW])[TIME]
        self.assertAlmostEqual(held_s, 0.1, delta=0.02)
        sim.run_until(0.5)
        frame = browser.frame(lambda frame: frame[NOW] > at_s)
        self.assertEqual(frame[TIME], held_s)
        browser.send(type="resume")
        browser.frame(lambda frame: frame[TIME] == sim.time_s()[0])
        browser.send(type="pause")
        browser.send(type="speed", factor=0.5)
        self.assertIn("not possible", browser.message("error")["text"])

    def test_one_world_of_several_is_shown(self):
        batch = taut.Batch(taut.load(PRISM), worlds=3)
        batch.set_parameter("gravity_z_m_per_s2", [-1, -5, -10])
        view = self.show(batch, world=1)
        self.assertEqual(self.show(batch, world=1).url, view.url)
        self.assertNotEqual(self.show(batch, world=2).url, view.url)
        browser = self.browser(view)
        batch.step(1e-3, 100)
        frame = browser.frame(lambda frame: frame[TIME] == batch.time_s()[1])
        self.assertEqual(frame[HEADER:HEADER + 3], tuple(batch.body_position_m()[1, 0]))
        with self.assertRaises(IndexError):
            batch.show(world=3, browser=False)

    # --- effects on the program ------------------------------------------------------------------------------------
    def test_results_have_the_same_bits_with_and_without(self):
        def hashes(shown):
            sim, batch = taut.Simulation(PUSH, worlds=2), taut.Batch(taut.load(PUSH).robot, worlds=2)
            if shown:
                views = [self.show(what, world=world) for what in (sim, batch) for world in (0, 1)]
                browsers = [self.browser(view) for view in views]
            end = time.monotonic() + (0.3 if shown else 0)
            for count in range(1, 40):
                sim.step(count)
                sim.run_until(0.01 * count)
                batch.step(1e-3, 50)
                time.sleep(max(0, end - time.monotonic()) / 40)
            if shown:
                for browser in browsers:
                    browser.frame(lambda frame: frame[TIME] > 0)
            return [what.hash(world) for what in (sim, batch) for world in (0, 1)]

        self.assertEqual(hashes(True), hashes(False))

    def test_a_browser_that_reads_nothing_does_not_delay_the_program(self):
        sim = taut.Simulation(PUSH)
        self.browser(self.show(sim))
        slowest = 0.0
        for _ in range(300):
            start = time.monotonic()
            sim.step()
            slowest = max(slowest, time.monotonic() - start)
            time.sleep(0.002)
        self.assertLess(slowest, 5)

    def test_controllers_in_python_and_threads(self):
        class Hold:
            period_s = 0.01
            stateless = True

            def act(self, seen, commands):
                commands.rest_length_m[:] = seen.cable_length_m - 0.005

        sim = taut.Simulation(taut.load(PUSH).without_controllers(), controllers=[Hold()])
        browser = self.browser(self.show(sim))
        threads = [threading.Thread(target=lambda: [sim.step() for _ in range(200)]) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        browser.frame(lambda frame: frame[TIME] == sim.time_s()[0])

    # --- the end ----------------------------------------------------------------------------------------------------
    def test_close_ends_the_server(self):
        sim = taut.Simulation(PUSH)
        with sim.show(browser=False) as view:
            browser = self.browser(view)
            self.assertEqual(repr(view), f"<taut.LiveView: {view.url}>")
        self.closes(browser)
        self.assertTrue(view.closed)
        self.assertEqual(repr(view), "<taut.LiveView: closed>")
        with self.assertRaises(urllib.error.URLError):
            urllib.request.urlopen(view.url, timeout=5)
        sim.step()
        view.close()
        self.assertFalse(self.show(sim).closed)

    def test_a_view_keeps_the_last_state_of_a_deleted_simulation(self):
        sim = taut.Simulation(PUSH)
        view = self.show(sim)
        sim.run_until(0.2)
        last_s = sim.time_s()[0]
        del sim
        gc.collect()
        browser = self.browser(view)
        browser.frame(lambda frame: frame[TIME] == last_s)
        self.assertFalse(view.closed)

    def test_the_server_ends_with_simulation_and_view(self):
        sim = taut.Simulation(PUSH)
        view = sim.show(browser=False)
        url, browser = view.url, self.browser(view)
        del view
        gc.collect()
        urllib.request.urlopen(url, timeout=5).close()
        del sim
        gc.collect()
        self.closes(browser)
        with self.assertRaises(urllib.error.URLError):
            urllib.request.urlopen(url, timeout=5)

    def program(self, text, code=0):
        done = subprocess.run([sys.executable, "-W", "ignore", "-c", f"import os, signal, sys, threading, time, taut\nPUSH = {PUSH!r}\n{text}"],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((done.returncode, done.stderr), (code, ""), done.stdout)
        return done.stdout

    def test_a_program_ends_with_an_open_view(self):
        self.program("""
sim = taut.Simulation(PUSH)
view = sim.show(browser=False)
sim.step()
threading.Thread(target=lambda: [sim.step() for _ in range(10**9)], daemon=True).start()
time.sleep(0.2)""")

    def test_a_forked_child_leaves_the_view_to_its_parent(self):
        out = self.program("""
sim = taut.Simulation(PUSH)
view = sim.show(browser=False)
sim.step()
child = os.fork()
if child == 0:
    assert view.closed
    view.close()
    try:
        sim.show(browser=False)
    except RuntimeError as error:
        print("refused:", "fork" in str(error), flush=True)
    del sim, view
    sys.exit(0)
assert os.waitpid(child, 0)[1] == 0
import urllib.request
print(urllib.request.urlopen(view.url).status, view.closed)""")
        self.assertEqual(out, "refused: True\n200 False\n")

    def test_control_c_interrupts_a_wait_of_the_program(self):
        self.show(taut.Simulation(PUSH))
        interrupted(self, lambda: time.sleep(30))

    # --- arguments and surroundings ---------------------------------------------------------------------------------
    def test_only_notebooks_of_this_machine_may_frame_the_page(self):
        view = self.show(taut.Simulation(MASS))
        with urllib.request.urlopen(view.url) as answer:
            policy = answer.headers["Content-Security-Policy"]
        self.assertIn("frame-ancestors http://localhost:* http://127.0.0.1:*", policy)
        with self.assertRaises(urllib.error.HTTPError):
            urllib.request.urlopen(view.url.partition("?")[0])

    def test_a_browser_opens_by_itself_unless_in_a_notebook(self):
        sim = taut.Simulation(MASS)
        with mock.patch("webbrowser.open", return_value=True) as opened:
            view = sim.show()
            self.addCleanup(view.close)
            opened.assert_called_once_with(view.url)
        with mock.patch("webbrowser.open", return_value=False), mock.patch("builtins.print") as printed:
            sim.show()
            self.assertIn(view.url, printed.call_args[0][0])
        notebook = mock.Mock()
        with mock.patch.dict(sys.modules, {"IPython": notebook, "IPython.display": notebook.display}), \
                mock.patch("webbrowser.open") as opened:
            sim.show(height_px=500)
            notebook.display.IFrame.assert_called_once_with(view.url, "100%", 500)
            notebook.display.display.assert_called_once_with(notebook.display.IFrame.return_value)
            opened.assert_not_called()

    def test_missing_pages_are_named(self):
        with mock.patch.dict(os.environ, TAUT_WEB="/nowhere"):
            with self.assertRaisesRegex(FileNotFoundError, "needs the viewer's pages, which are missing"):
                taut.Simulation(MASS).show(browser=False)

    def test_wrong_arguments_raise(self):
        sim = taut.Simulation(MASS)
        for options, error in (({"world": 1}, IndexError), ({"world": "a"}, TypeError), ({"port": 65536}, ValueError),
                               ({"port": -1}, ValueError), ({"height_px": 5}, ValueError), ({"browser": 3}, TypeError)):
            with self.subTest(options), self.assertRaises(error):
                sim.show(**{"browser": False, **options})
        view = self.show(sim)
        port = int(view.url.split(":")[2].split("/")[0])
        with self.assertRaisesRegex(taut.InputError, f"port {port} is in use"):
            taut.Simulation(MASS).show(browser=False, port=port)


if __name__ == "__main__":
    main()
