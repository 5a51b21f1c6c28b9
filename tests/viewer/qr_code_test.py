"""`taut view --listen 0.0.0.0` prints its address as a QR code to a terminal; zbarimg reads it.

Usage: qr_code_test.py TAUT
"""

import os
import pathlib
import pty
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77
HALVES = {" ": (0, 0), "\u2580": (1, 0), "\u2584": (0, 1), "\u2588": (1, 1)}  # dark above, dark below
PIXELS = 4  # per module


def printed_by(arguments, terminal):
    """Returns what the command prints up to its warning about other machines."""
    ours, theirs = pty.openpty() if terminal else os.pipe()
    with subprocess.Popen(arguments, stdout=theirs, stderr=theirs) as server:
        os.close(theirs)
        text = b""
        while b"other machines can connect" not in text:
            more = os.read(ours, 1 << 16)
            assert more, text
            text += more
        server.terminate()
        while True:  # the server may wait for a reader
            try:
                if not os.read(ours, 1 << 16):
                    break
            except OSError:  # a terminal without a writer
                break
    os.close(ours)
    return text.decode()


def image(code_lines):
    """Returns the lines of a code as a portable graymap (PGM)."""
    rows = []
    for line in code_lines:
        for half in (0, 1):
            row = b"".join(bytes([255 * (1 - HALVES[letter][half])]) * PIXELS for letter in line)
            rows += [row] * PIXELS
    return b"P5 %d %d 255\n" % (len(rows[0]), len(rows)) + b"".join(rows)


def main():
    arguments = [sys.argv[1], "view", str(ROOT / "share/models/rod.yaml"), "--port", "0", "--listen", "0.0.0.0"]
    assert "\u2588" not in printed_by(arguments, terminal=False), "a QR code in a file or a pipe"
    features = subprocess.run([sys.argv[1], "--version", "--features"], capture_output=True, text=True, check=True)
    if "QR codes: yes" not in features.stdout or not shutil.which("zbarimg"):
        print("skipped: no QR codes in this build, or no zbarimg (zbar-tools)")
        return SKIPPED
    text = printed_by(arguments, terminal=True)
    lines = re.findall(r"\x1b\[38;5;16;48;5;231m([^\x1b]*)\x1b\[0m", text)
    said = re.search(r"On a phone: (http://\S+:\d+/\?token=\w+)", text)[1]
    first = re.search(r"http://\S+:(\d+/\?token=\w+)", text)[1]
    assert said.endswith(first), (said, first)
    assert re.match(r"http://[\d.]+:", said), said
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "code.pgm"
        path.write_bytes(image(lines))
        read = subprocess.run(["zbarimg", "--quiet", "--raw", path], capture_output=True, text=True, check=True)
    assert read.stdout.strip() == said, (read.stdout, said)
    return 0


if __name__ == "__main__":
    sys.exit(main())
