"""An independent client of the robot's USB-ISS adapter and of its boards, which shares no code with taut's

Frames of the adapter follow Devantech's documents only: "USB-ISS Technical documentation" of 16/09/22 and the pages
usb_iss_tech and usb_iss_i2c_tech. Messages of the boards follow docs/hardware/protocol.md.
"""

import os
import pathlib
import select
import signal
import struct
import subprocess
import termios
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PATIENCE_S = 60  # limit for events that are immediate on an idle machine
GAP_S = 0.005  # after this gap the adapter treats bytes as another frame
BOARDS, MOTORS = 6, 2
OFF, HOLD, POSITION, IMPEDANCE, DUTY, REPLY, STOPPED = 0, 1, 2, 3, 4, 5, 7
EMERGENCY_STOP = bytes.fromhex("ce 53 54 39")
INFO, FAULTS, COUNTERS = 0xF0, 0xF1, 0xF2


def crc(data, width, polynomial, start):
    """Returns the CRC: highest bit first, no reflection, no final XOR."""
    top, mask, value = 1 << (width - 1), (1 << width) - 1, start
    for byte in data:
        value ^= byte << (width - 8)
        for _ in range(8):
            value = ((value << 1) ^ (polynomial if value & top else 0)) & mask
    return value


def crc8(data, start=0x00):
    return bytes([crc(data, 8, 0x07, start)])


def crc16(data):
    return struct.pack(">H", crc(data, 16, 0x1021, 0xFFFF))


def cyclic(sequence, mode=OFF, values=(0,) * 12, arm=0, capture=False, clear=False, zero=False):
    bits = mode | capture << 3 | clear << 4 | zero << 5 | arm << 6
    message = bytes([0xC1, sequence, bits]) + struct.pack("<12h", *values)
    return message + crc16(message)


def setting(parameter, index, value):
    message = struct.pack("<BBBf", 0xD1, parameter, index, value)
    return message + crc16(message)


def question(what, index=2):
    message = bytes([0xD2, what, index])
    return message + crc8(message)


def action(what, index, value, boot):
    message = struct.pack("<BBBiH", 0xD3, what, index, value, boot)
    return message + crc16(message)


def write_address(board):
    return (0x10 + board) << 1


def read_address(board):
    return write_address(board) | 1


def good_frame(board, frame):
    """Returns whether 16 bytes are a frame of this board."""
    return len(frame) == 16 and crc8(bytes([board]) + frame[:15], start=0xFF) == frame[15:]


class Motor:
    def __init__(self, six):
        self.reading_counts = (six[0] | (six[1] & 0x0F) << 8) / 4
        self.set_point_counts = (six[1] >> 4 | six[2] << 4) / 4
        self.encoder, duty = struct.unpack("<Hb", six[3:6])
        self.duty = duty / 127


class Status:
    def __init__(self, frame):
        self.sequence, bits = frame[0], frame[1]
        self.mode = bits & 7
        self.referenced, self.wrong, self.timeout, self.late, self.was_reset = (
            bool(bits & 1 << bit) for bit in range(3, 8))
        self.motors = [Motor(frame[2:8]), Motor(frame[8:14])]
        self.extra = frame[14]


class Robot:
    """The virtual robot's process, and the terminal of its adapter

    The gears are self-locking: otherwise a robot with its motors off would sink, and its boards would compute
    overheated windings for motors that are turned by their cables. The time with motors off depends on the speed of the
    machine.
    """

    def __init__(self, program, folder):
        self.link, self.log = pathlib.Path(folder, "robot"), pathlib.Path(folder, "log")
        self.terminal = None
        self.process = subprocess.Popen(
            [program, "--model", ROOT / "share/models/tetraspine3_motors.yaml", "--link", self.link, "--log", self.log,
             "--frames", "--set", "gear_efficiency=0.45"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.said = self.process.stdout.readline()  # its terminal is open now, or it has ended
        if not self.said:
            raise AssertionError(f"{program} ended with status {self.process.wait()}")
        self.open()

    def open(self):
        """Opens the terminal like a serial port; the baud rate has no effect."""
        self.terminal = os.open(self.link, os.O_RDWR | os.O_NOCTTY)
        settings = termios.tcgetattr(self.terminal)
        settings[0] = settings[1] = settings[3] = 0  # raw bytes
        settings[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
        settings[6][termios.VMIN], settings[6][termios.VTIME] = 1, 0
        termios.tcsetattr(self.terminal, termios.TCSANOW, settings)

    def close(self):
        os.close(self.terminal)
        self.terminal = None

    def end(self):
        """Ends the process with Ctrl-C. Returns its exit status."""
        if self.terminal is not None:
            self.close()
        self.process.send_signal(signal.SIGINT)
        self.process.stdout.close()
        return self.process.wait(PATIENCE_S)

    def waiting(self, seconds=0.0):
        return bool(select.select([self.terminal], [], [], seconds)[0])

    def send(self, frame):
        """Sends a frame in one piece, as the adapter requires."""
        if os.write(self.terminal, frame) != len(frame):
            raise AssertionError("a frame was torn")

    def receive(self, count):
        reply, until = b"", time.monotonic() + PATIENCE_S
        while len(reply) < count:
            if not self.waiting(until - time.monotonic() if time.monotonic() < until else 0):
                raise AssertionError(f"{len(reply)} bytes of {count}: {reply.hex(' ')}")
            reply += os.read(self.terminal, count - len(reply))
        return reply

    def ask(self, frame, count):
        if self.waiting():
            raise AssertionError(f"nobody asked for {os.read(self.terminal, 256).hex(' ')}")
        self.send(frame)
        return self.receive(count)

    def taken(self):
        """Returns the frames taken by the adapter so far, one hexadecimal text per burst."""
        lines = self.log.read_text().splitlines()
        return [line.split("usb: > ")[1] for line in lines if "usb: > " in line]

    def send_and_see(self, frame):
        """Sends a frame and waits until the adapter has taken it and a gap has passed, so that the next bytes are
        another frame."""
        before, until = len(self.taken()), time.monotonic() + PATIENCE_S
        self.send(frame)
        while len(self.taken()) == before:
            if time.monotonic() > until:
                raise AssertionError(f"{frame.hex(' ')} was never taken")
            time.sleep(0.002)
        if self.taken()[before:] != [frame.hex(" ")]:
            raise AssertionError(f"{frame.hex(' ')} was taken as {self.taken()[before:]}")
        time.sleep(GAP_S)

    # --- adapter ---

    def version(self):
        return self.ask(bytes.fromhex("5a 01"), 3)

    def set_mode(self, *bytes_after):
        return self.ask(bytes([0x5A, 0x02, *bytes_after]), 2)

    def is_there(self, address):
        return self.ask(bytes([0x58, address]), 1) != b"\0"

    def write(self, address, data):
        """Writes by I2C_AD0. Returns whether the data were acknowledged."""
        return self.ask(bytes([0x54, address, len(data)]) + data, 1) != b"\0"

    def read(self, address, count):
        return self.ask(bytes([0x54, address | 1, count]), count)

    def direct(self, *parts):
        """Executes I2C_DIRECT. Returns the bytes that were read, or an error number."""
        status, number = self.ask(bytes([0x57, *parts]), 2)
        if status == 0:
            return number
        return self.receive(number)

    # --- boards ---

    def broadcast(self, *arguments, **options):
        return self.write(0x00, cyclic(*arguments, **options))

    def statuses(self):
        """Returns the statuses of all boards, by two DIRECTs of three boards each."""
        frames = b""
        for first in (0, 3):
            parts = []
            for board in range(first, first + 3):  # 16 bytes, the last without acknowledgement
                parts += [0x01, 0x30, read_address(board), 0x2E, 0x04, 0x20, 0x03]
            got = self.direct(*parts)
            if got == 1:
                raise AssertionError("a board did not answer")
            frames += got
        parts = [frames[16 * board:16 * board + 16] for board in range(BOARDS)]
        for board, frame in enumerate(parts):
            if not good_frame(board, frame):
                raise AssertionError(f"board {board}: {frame.hex(' ')}")
        return [Status(frame) for frame in parts]

    def status(self, board):
        frame = self.read(read_address(board), 16)
        if not good_frame(board, frame):
            raise AssertionError(f"board {board}: {frame.hex(' ')}")
        return Status(frame)

    def until(self, board, wanted):
        """Waits for a status that fulfills `wanted`. A status may lag behind the last broadcast."""
        return self.repeat(lambda: self.status(board), wanted)

    def request(self, board, message):
        """Sends a request. Returns the result and the payload of the reply."""
        if not self.write(write_address(board), message):
            raise AssertionError("a request was not acknowledged")
        # Until the board has read the request, which takes longer after a load from the EEPROM, it sends its previous
        # reply.
        frame = self.repeat(lambda: self.read(read_address(board), 16),
                            lambda frame: good_frame(board, frame) and frame[1] == REPLY
                            and (frame[0], frame[2]) == (message[1], message[2]))
        return frame[3], frame[4:15]

    def value(self, board, parameter, index):
        result, payload = self.request(board, question(parameter, index))
        return struct.unpack("<f", payload[:4])[0] if result == 0 else None

    @staticmethod
    def repeat(look, wanted):
        end = time.monotonic() + PATIENCE_S
        while True:
            found = look()
            if wanted(found):
                return found
            if time.monotonic() > end:
                raise AssertionError(f"it stays {vars(found) if hasattr(found, '__dict__') else found}")
