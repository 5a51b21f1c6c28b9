"""Runs a program whose n-th call of some kind fails, with tests/faults/inject_faults.cpp preloaded."""

import dataclasses
import errno
import mmap
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile

from validation.runs import Problem

KINDS = ("memory", "hdf5", "write", "sync", "name", "open", "truncate", "close", "read")  # as in faults.cpp
ERRORS = {"memory": errno.ENOMEM, "hdf5": errno.ENOMEM, "write": errno.ENOSPC, "sync": errno.EIO, "name": errno.EIO,
          "open": errno.ENOSPC, "truncate": errno.EIO, "close": errno.EIO, "read": errno.EIO}
KILL_KINDS = ("write", "sync", "name", "open", "truncate", "close")  # calls at which an operation may be incomplete
MODES = ("once", "sticky", "kill")
PATIENCE_S = 120  # timeout of one program
RECORD_BYTES = 8 * (len(KINDS) + 1) + 200


@dataclasses.dataclass(frozen=True)
class Fault:
    """The n-th call of a kind fails: once, from then on ("sticky"), or the process is killed there ("kill")."""
    kind: str
    at: int
    mode: str = "once"

    def environment(self):
        return {"TAUT_FAULT_KIND": self.kind, "TAUT_FAULT_AT": str(self.at),
                "TAUT_FAULT_STICKY": "yes" if self.mode == "sticky" else "",
                "TAUT_FAULT_ERROR": "kill" if self.mode == "kill" else str(ERRORS[self.kind])}

    def __str__(self):
        return f"{self.kind} {self.at} {self.mode}"


@dataclasses.dataclass
class Outcome:
    """End of a program. `status` is negative if a signal ended it, as in subprocess."""
    status: int
    output: str
    errors: str
    calls: dict    # by kind
    failed: int    # number of failed ones
    first: str     # name of the first failed one

    @property
    def crashed(self):
        return self.status < 0 and -self.status != signal.SIGKILL


class Shared:
    """Memory shared by program and driver: counts of calls, and the fault."""

    def __init__(self, folder):
        file, self.path = tempfile.mkstemp(dir=folder, prefix="faults_")
        os.ftruncate(file, RECORD_BYTES)
        self.memory = mmap.mmap(file, RECORD_BYTES)
        os.close(file)

    def numbers(self):
        return struct.unpack_from(f"{len(KINDS) + 1}q", self.memory)

    @property
    def failed(self):
        return self.numbers()[-1]

    def outcome(self, status, output, errors):
        *calls, failed = self.numbers()
        first = self.memory[8 * (len(KINDS) + 1):].split(b"\0")[0].decode(errors="replace").strip()
        return Outcome(status, output, errors, dict(zip(KINDS, calls)), failed, first)

    def close(self):
        self.memory.close()
        os.unlink(self.path)


class Program:
    """The taut command with the library preloaded, the Python of the module, and the boards for `taut robot`."""

    def __init__(self, command, library, variables=None, python=sys.executable, adapter=None):
        self.variables, self.python, self.adapter = variables or {}, python, adapter
        for path in (command, library):
            if not pathlib.Path(path).exists():
                raise Problem(f"there is no {path}; script/build makes it")
        self.command, self.library = str(pathlib.Path(command).resolve()), str(pathlib.Path(library).resolve())

    def environment(self, shared, fault):
        return {**os.environ, **self.variables, "LD_PRELOAD": self.library, "TAUT_FAULTS": shared.path,
                **(fault.environment() if fault else {})}

    def instead(self, command, variables):
        """Returns another program with this library and these environment variables."""
        return Program(command, self.library, variables)

    def run(self, words, folder, fault=None, during=None, lines=""):
        """Runs once in `folder`, with output to files, as on a disk, and `lines` as input. `during(process, shared,
        output)` is called after the start for programs that must be ended from outside; output() returns the output so
        far."""
        shared = Shared(folder.parent)
        try:
            with tempfile.TemporaryFile("w+", dir=folder.parent, errors="replace") as output, \
                    tempfile.TemporaryFile("w+", dir=folder.parent, errors="replace") as errors, \
                    tempfile.TemporaryFile("w+", dir=folder.parent) as given:
                given.write(lines)
                given.seek(0)
                process = subprocess.Popen([self.command, *map(str, words)], cwd=folder, stdin=given, stdout=output,
                                           stderr=errors, env=self.environment(shared, fault))
                try:
                    if during:
                        during(process, shared, lambda: pathlib.Path(f"/proc/self/fd/{output.fileno()}").read_text())
                    status = process.wait(PATIENCE_S)
                except subprocess.TimeoutExpired:
                    status = None
                finally:
                    if process.poll() is None:
                        process.kill()
                        process.wait()
                output.seek(0)
                errors.seek(0)
                return shared.outcome(status, output.read(), errors.read())
        finally:
            shared.close()

    def plain(self, words, folder):
        """Runs without faults and without the library, to see the result as a user does."""
        return subprocess.run([self.command, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL,
                              env={**os.environ, **self.variables}, capture_output=True, text=True, errors="replace",
                              timeout=PATIENCE_S)
