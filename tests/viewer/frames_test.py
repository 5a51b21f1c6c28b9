"""A live run survives clients that violate the WebSocket protocol.

Usage: frames_test.py TAUT
"""

import base64
import contextlib
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TAUT = sys.argv[1]
TEXT, BINARY, CONTINUED, CLOSE, PING, PONG = 1, 2, 0, 8, 9, 10
PAUSE = b'{"type":"pause"}'


def frame(opcode, data=b"", *, last=True, reserved=0, masked=True, claims=None):
    """Returns a WebSocket frame. `claims`: length in the header, if not the true length."""
    length = len(data) if claims is None else claims
    head = bytes([last << 7 | reserved << 4 | opcode])
    mask = masked << 7
    if length < 126:
        head += bytes([mask | length])
    elif length < 2**16:
        head += bytes([mask | 126]) + struct.pack(">H", length)
    else:
        head += bytes([mask | 127]) + struct.pack(">Q", length)
    if not masked:
        return head + data
    key = os.urandom(4)
    return head + key + bytes(byte ^ key[i % 4] for i, byte in enumerate(data))


ATTACKS = {
    "not masked": frame(TEXT, PAUSE, masked=False),
    "a reserved bit": frame(TEXT, PAUSE, reserved=4),
    "a reserved kind of data": frame(3, b"x"),
    "a reserved kind of control": frame(15),
    "a length beyond 63 bits": frame(TEXT, b"x", claims=2**63),
    "a length of exabytes": frame(TEXT, b"x", claims=2**62),
    "a long ping": frame(PING, 126 * b"x"),
    "a ping in parts": frame(PING, b"x", last=False),
    "an end without a beginning": frame(CONTINUED, b"x"),
    "a message inside of another": frame(TEXT, b"{", last=False) + frame(TEXT, b"}"),
    "no UTF-8": frame(TEXT, b'{"type":"\xff\xfe"}'),
    "half a letter": frame(TEXT, b'{"type":"\xe2\x82"}'),
    "zeros": frame(TEXT, bytes(100)),
    "a close of one byte": frame(CLOSE, b"\x03"),
    "a close with a reason that is none": frame(CLOSE, struct.pack(">H", 999)),
    "a close without UTF-8": frame(CLOSE, struct.pack(">H", 1000) + b"\xff"),
    "binary": frame(BINARY, b"x"),
    "many pings": 1000 * frame(PING, b"x"),
    "many pongs": 100 * frame(PONG, b"x"),
    "many parts of nothing": frame(TEXT, last=False) + 1000 * frame(CONTINUED, last=False),
    "parts without end": frame(TEXT, b"[", last=False) + 10 * frame(CONTINUED, 60000 * b"[", last=False),
    "half a head": b"\x81",
    "noise": os.urandom(4000),
    "HTTP once more": b"GET / HTTP/1.1\r\n\r\n",
    "the same again and again": 50 * frame(TEXT, PAUSE),
    "words after the close": frame(CLOSE, struct.pack(">H", 1000)) + frame(TEXT, PAUSE),
}


def client(port, token):
    stream = socket.create_connection(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    stream.sendall(f"GET /ws?token={token} HTTP/1.1\r\nHost: localhost:{port}\r\nUpgrade: websocket\r\n"
                   f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    answer = stream.recv(4096)
    assert answer.startswith(b"HTTP/1.1 101 "), answer
    return stream


def attack(web):
    for page in ("index.html", "report.html"):
        pathlib.Path(web, page).write_text("<p>the page")
    words = [TAUT, "view", str(ROOT / "share/experiments/hang.yaml"), "--paused", "--port", "0"]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env={**os.environ, "TAUT_WEB": web})
    try:
        port, token = re.search(r":(\d+)/\?token=(\S+)", server.stdout.readline()).groups()
        with client(int(port), token) as good:
            for name, frames in ATTACKS.items():
                with client(int(port), token) as bad, contextlib.suppress(ConnectionError, TimeoutError):
                    bad.settimeout(0.2)
                    bad.sendall(frames)
                    while bad.recv(65536):
                        pass
                assert server.poll() is None, f"{name}: ended with status {server.returncode}"
            good.sendall(frame(TEXT, PAUSE))
            assert good.recv(10), "who behaves is served"
        server.terminate()
        assert server.wait() == 0, server.returncode
    finally:
        server.kill()
        server.wait()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        attack(folder)
