"""The command `taut` of a wheel: `python3 -m taut run experiments/push_20n.yaml`."""

import os
import signal
import sys

from taut import _core


def main() -> int:
    if not hasattr(_core, "main"):
        sys.exit("this build of the Python module does not contain the command: use the program `taut`")
    for stop in (signal.SIGINT, signal.SIGTERM):  # the command handles them
        signal.signal(stop, signal.SIG_DFL)
    os.environ.setdefault("TAUT_PYTHON", sys.executable)  # `taut plot` draws with this Python's matplotlib
    sys.stdout.flush()
    status = _core.main(_core.__file__, sys.argv[1:])
    os._exit(status)  # the command has finished its output


if __name__ == "__main__":
    main()
