"""`taut view` follows changes of its input files: it restarts with them, or shows their errors.

Usage: reload_test.py TAUT
"""

import base64
import json
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TAUT = sys.argv[1]
PATIENCE_S = 60


class Client:
    """A browser's connection: reads the text messages of the server."""

    def __init__(self, port, token):
        self.stream = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        key = base64.b64encode(os.urandom(16)).decode()
        self.stream.sendall(f"GET /ws?token={token} HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\n"
                            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
                            .encode())
        self.bytes = b""
        while b"\r\n\r\n" not in self.bytes:
            self.bytes += self.stream.recv(4096)
        self.bytes = self.bytes.split(b"\r\n\r\n", 1)[1]

    def take(self, count):
        while len(self.bytes) < count:
            more = self.stream.recv(1 << 16)
            assert more, "the server has closed the connection"
            self.bytes += more
        taken, self.bytes = self.bytes[:count], self.bytes[count:]
        return taken

    def await_message(self, wanted):
        """Returns the next text message that fulfills `wanted`."""
        end_s, opcode, parts = time.monotonic() + PATIENCE_S, 0, b""
        while time.monotonic() < end_s:
            kind, length = self.take(2)
            if length == 126:
                length, = struct.unpack(">H", self.take(2))
            elif length == 127:
                length, = struct.unpack(">Q", self.take(8))
            data = self.take(length)
            if kind & 15 == 0:  # a further part of a text or of a frame
                parts += data
            elif kind & 15 in (1, 2):
                opcode, parts = kind & 15, data
            if kind & 128 and opcode == 1:
                message, opcode = json.loads(parts), 0
                if wanted(message):
                    return message
        raise AssertionError("the message did not come")

    def await_scene(self, wanted):
        return self.await_message(lambda m: m["type"] == "scene" and wanted(m["scene"]))["scene"]

    def send(self, message):
        data = json.dumps(message).encode()
        assert len(data) < 126
        self.stream.sendall(bytes([0x81, 0x80 | len(data)]) + bytes(4) + data)


class Viewed:
    """`taut view` of a file or folder, with a client."""

    def __init__(self, path, web):
        self.server = subprocess.Popen([TAUT, "view", str(path), "--port", "0"], stdout=subprocess.PIPE, text=True,
                                       env={**os.environ, "TAUT_WEB": str(web)})
        port, token = re.search(r":(\d+)/\?token=(\S+)", self.server.stdout.readline()).groups()
        self.client = Client(int(port), token)

    def __enter__(self):
        return self.client

    def __exit__(self, *_):
        self.server.kill()
        self.server.wait()


def replace(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def stiffness_n_per_m(scene):
    return scene["cables"][0]["stiffness_n_per_m"]


def a_changed_model_is_shown(robot, web):
    with Viewed(robot, web) as client:  # the folder stands for its model
        assert stiffness_n_per_m(client.await_scene(lambda s: True)) == 1000
        replace(robot / "model.yaml", "stiffness_n_per_m: 1.0 N", "stiffness_n_per_m: 2.0 N")
        scene = client.await_scene(lambda s: stiffness_n_per_m(s) == 2000)
        assert "notice" not in scene


def a_dropped_model_is_dropped_again(robot, web):
    with Viewed(robot, web) as client:
        client.await_scene(lambda s: True)
        client.send({"type": "start", "as": "dropped"})
        client.await_scene(lambda s: s["terrain"])
        replace(robot / "model.yaml", "stiffness_n_per_m: 1.0 N", "stiffness_n_per_m: 3.0 N")
        scene = client.await_scene(lambda s: stiffness_n_per_m(s) == 3000)
        assert scene["terrain"], "the changed model is without ground"


def errors_are_shown_until_they_are_mended(robot, web):
    with Viewed(robot, web) as client:
        client.await_scene(lambda s: True)
        replace(robot / "model.yaml", "prestress_n: 10 ", "prestres_n: 10 ")
        scene = client.await_scene(lambda s: "notice" in s)
        assert re.search(r"model\.yaml:\d+:\d+: error: .*prestress_n", scene["notice"]), scene["notice"]
        assert len(scene["cables"]) == 9, "the robot before the change is shown"
        replace(robot / "model.yaml", "prestres_n: 10 ", "prestress_n: 10 ")
        assert "notice" not in client.await_scene(lambda s: True)


def another_kind_of_file_is_an_error(robot, web):
    with Viewed(robot / "model.yaml", web) as client:
        client.await_scene(lambda s: True)
        shutil.copyfile(ROOT / "share/robots/blank/model.yaml", robot / "other.yaml")
        replace(robot / "drop.yaml", "model: model.yaml", "model: other.yaml")
        shutil.copyfile(robot / "drop.yaml", robot / "model.yaml")
        assert "the kind of the file has changed" in client.await_scene(lambda s: "notice" in s)["notice"]


def an_experiment_restarts_with_its_changed_model(robot, web):
    with Viewed(robot / "drop.yaml", web) as client:
        client.await_scene(lambda s: True)
        replace(robot / "model.yaml", "stiffness_n_per_m: 1.0 N", "stiffness_n_per_m: 4.0 N")
        client.await_message(lambda m: m["type"] == "event" and m["text"] == "restarted with the changed files")
        client.await_scene(lambda s: stiffness_n_per_m(s) == 4000)
        (robot / "model.yaml").unlink()
        scene = client.await_scene(lambda s: "notice" in s)
        assert "model.yaml" in scene["notice"], scene["notice"]


def a_pipe_in_place_of_a_file_is_an_error(robot, web):
    viewed = Viewed(robot, web)
    with viewed as client:
        client.await_scene(lambda s: True)
        model = robot / "model.yaml"
        text = model.read_text()
        model.unlink()
        os.mkfifo(model)
        notice = client.await_scene(lambda s: "notice" in s)["notice"]
        assert "the file was replaced by a pipe, socket or device" in notice, notice
        model.unlink()
        model.write_text(text)
        assert "notice" not in client.await_scene(lambda s: True)
        model.unlink()
        os.mkfifo(model)
        client.await_scene(lambda s: "notice" in s)
        viewed.server.terminate()
        assert viewed.server.wait(PATIENCE_S) == 0


if __name__ == "__main__":
    for test in (a_changed_model_is_shown, a_dropped_model_is_dropped_again, errors_are_shown_until_they_are_mended,
                 another_kind_of_file_is_an_error, a_pipe_in_place_of_a_file_is_an_error,
                 an_experiment_restarts_with_its_changed_model):
        with tempfile.TemporaryDirectory() as folder:
            pages = pathlib.Path(folder, "web")
            pages.mkdir()
            for page in ("index.html", "report.html"):
                (pages / page).write_text("<p>the page")
            template = pathlib.Path(folder, "robot")
            shutil.copytree(ROOT / "share/robots/prism", template)
            test(template, pages)
            print(f"{test.__name__}: good")
