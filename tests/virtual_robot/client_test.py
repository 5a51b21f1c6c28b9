"""The virtual robot tested by an independent client (client.py) through its pseudo-terminal

Usage: client_test.py PROGRAM TEST. TEST is the name of a test of this file. No test depends on the speed of the
machine.
"""

import os
import pathlib
import re
import struct
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
from client import (BOARDS, COUNTERS, EMERGENCY_STOP, FAULTS, HOLD, IMPEDANCE, INFO, MOTORS, OFF,  # noqa: E402
                    POSITION, ROOT, STOPPED, Robot, action, crc8, crc16, cyclic, good_frame, question, read_address, setting,
                    write_address)

PROGRAM = sys.argv[1]
NOBODY = 0x40  # no board has this address
HARDWARE_400_KHZ = (0x70, 0x04)
DONE, UNKNOWN_COMMAND = b"\xff\x00", b"\x00\x05"


class Client(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.robot = Robot(PROGRAM, self.folder.name)
        self.addCleanup(self.robot.end)
        if self._testMethodName != "SaysWhatItIs":
            self.assertEqual(self.robot.set_mode(*HARDWARE_400_KHZ), DONE)
            # A board starts 15 ms or more after power on, and has a current status after a broadcast.
            self.robot.repeat(self.look, bool)

    def look(self):
        """Returns whether board 5 is there. The board receives an empty message, which it counts as bad."""
        there = self.robot.is_there(write_address(5))
        self.looks = int(there)
        return there

    def ignored(self, *frames):
        """Checks that these frames get no answer, and that the next request is answered as usual."""
        for frame in frames:
            self.robot.send_and_see(frame)
            self.assertEqual(self.robot.version()[::2], b"\x07\x70", frame.hex(" "))

    # --- adapter ---

    def SaysWhatItIs(self):
        module, version, mode = self.robot.version()
        self.assertEqual((module, mode), (7, 0x40))
        self.assertGreaterEqual(version, 8, "which lets go of the bus after a NACK in DIRECT")
        self.assertRegex(self.robot.ask(bytes.fromhex("5a 03"), 8), rb"^[0-9]{8}$")

    def TakesItsModesAndNoOthers(self):
        for mode in (0x20, 0x30, 0x40, 0x50, 0x60, 0x70, 0x80, 0x00, 0x90, 0x91, 0x92, 0x93):
            self.assertEqual(self.robot.set_mode(mode, 0x04), DONE)
            self.assertEqual(self.robot.version()[2], mode)
        for mode in (0x21, 0x31, 0x41, 0x51, 0x61, 0x71, 0x81):  # with a serial port: its divisor in two bytes
            self.assertEqual(self.robot.set_mode(mode, 0x01, 0x37), DONE)
            self.assertEqual(self.robot.version()[2], mode)
        self.assertEqual(self.robot.set_mode(0x01, 0x00, 0x9B, 0xB0), DONE)
        self.assertEqual(self.robot.set_mode(*HARDWARE_400_KHZ), DONE)
        for mode in (0x72, 0x55, 0x94, 0xA0, 0xFF):
            self.assertEqual(self.robot.set_mode(mode, 0x04), UNKNOWN_COMMAND)
            self.assertEqual(self.robot.version()[2], 0x70, "as before")
        self.assertEqual(self.robot.ask(bytes.fromhex("5a 09"), 2), UNKNOWN_COMMAND)
        self.assertEqual(self.robot.set_mode(0x10, 0x04), DONE)  # IO_CHANGE, which does not affect I2C
        self.assertTrue(self.robot.is_there(write_address(0)))

    def FindsSixBoards(self):
        found = [address for address in range(1, 128) if self.robot.is_there(address << 1)]
        self.assertEqual(found, [0x10, 0x11, 0x12, 0x13, 0x14, 0x15])

    def FindsThemAtAnySpeed(self):
        for mode in (0x20, 0x30, 0x40, 0x50, 0x60, 0x70, 0x80):
            self.assertEqual(self.robot.set_mode(mode, 0x04), DONE)
            self.assertEqual([self.robot.is_there(write_address(board)) for board in range(7)], 6 * [True] + [False])

    def SaysOfNobodyThatNobodyIsThere(self):
        address = NOBODY << 1
        self.assertFalse(self.robot.is_there(address))
        for frame in (bytes([0x53, address, 1]), bytes([0x54, address, 2, 1, 2]), bytes([0x55, address, 0, 1, 5]),
                      bytes([0x56, address, 0, 0, 1, 5])):
            self.assertEqual(self.robot.ask(frame, 1), b"\0", frame.hex(" "))
        # A read has no error code; since version 3 it returns ones.
        self.assertEqual(self.robot.ask(bytes([0x53, address | 1]), 1), b"\xff")
        self.assertEqual(self.robot.read(address, 16), 16 * b"\xff")
        self.assertEqual(self.robot.ask(bytes([0x55, address | 1, 0, 16]), 16), 16 * b"\xff")
        self.assertEqual(self.robot.ask(bytes([0x56, address | 1, 0, 0, 16]), 16), 16 * b"\xff")
        self.assertEqual(self.robot.direct(0x01, 0x31, address, 1, 0x03), 1)
        self.assertEqual(self.robot.direct(0x01, 0x30, address | 1, 0x2F, 0x03), 1)
        # One missing board of three makes the whole frame fail.
        self.assertEqual(self.robot.direct(*[part for board in (0, NOBODY - 0x10, 1)
                                             for part in (0x01, 0x30, read_address(board), 0x2F, 0x03)]), 1)
        self.assertTrue(self.robot.broadcast(1))
        self.assertEqual([status.sequence for status in self.caught_up(1)], BOARDS * [1])

    def DirectNamesWhatIsWrong(self):
        address = write_address(0)
        for parts, error in (([0x01, 0x3F, address, *58 * [0]], 2), ([0x01, 0x33, address, 1, 2], 3),
                             ([0x01, 0x31, address], 3), ([0x01, 0x30, address, 0x05, 0x03], 4), ([0x01, 0x30, address, 0x40, 0x03], 4)):
            self.assertEqual(self.robot.direct(*parts), error, parts)
            self.assertTrue(self.robot.is_there(address), "the bus is free")
        self.assertEqual(self.robot.direct(0x01, 0x30, address, 0x03), b"", "nothing was to be read")

    def TakesWhatFitsIntoItsBufferAndNoMore(self):
        # 60 data bytes of AD1 or 59 of AD2 make a frame of 64, the size of the buffer.
        address, bad = write_address(0), self.counters(0)["bad"]
        self.robot.ask(bytes([0x55, address, 0, 60, *60 * [0]]), 1)
        self.robot.ask(bytes([0x56, address, 0, 0, 59, *59 * [0]]), 1)
        self.robot.repeat(lambda: self.counters(0)["bad"], lambda now: now == bad + 2)
        self.ignored(bytes([0x54, address, 70, *70 * [0]]), bytes([0x55, address, 0, 61, *61 * [0]]),
                     bytes([0x56, address, 0, 0, 60, *60 * [0]]))
        self.assertEqual(len(self.robot.ask(bytes([0x55, address | 1, 0, 60]), 60)), 60)
        self.assertEqual(len(self.robot.ask(bytes([0x56, address | 1, 0, 0, 64]), 64)), 64)
        self.ignored(bytes([0x55, address | 1, 0, 61]), bytes([0x56, address | 1, 0, 0, 65]))
        self.assertTrue(self.robot.broadcast(1))
        self.assertEqual([status.sequence for status in self.caught_up(1)], BOARDS * [1])

    def IgnoresFramesThatAreNotComplete(self):
        broadcast = bytes([0x54, 0x00, 29]) + cyclic(9, HOLD)
        for length in (1, 2, 3, 4, 20, len(broadcast) - 1):
            self.ignored(broadcast[:length])
        self.ignored(b"\x53", bytes([0x53, write_address(0)]), bytes([0x55, write_address(0), 0]), b"\x58", b"\x5a",
                     bytes.fromhex("5a 02"), bytes.fromhex("5a 02 70"), bytes.fromhex("5a 02 71 01"))
        self.assertTrue(self.robot.broadcast(3))
        self.assertEqual(self.caught_up(3)[0].sequence, 3)

    def IgnoresAFrameWithAGap(self):
        for sequence, length in enumerate((1, 3, 10, 30), 20):
            self.assertTrue(self.robot.broadcast(sequence))
            self.caught_up(sequence)
            torn = bytes([0x54, 0x00, 29]) + cyclic(99, values=12 * (0x7F7F,))
            self.robot.send_and_see(torn[:length])
            self.ignored(torn[length:])
            self.assertEqual(self.robot.status(0).sequence, sequence, "as before")

    def IgnoresCommandsThatThereAreNot(self):
        self.ignored(*(bytes([first, write_address(0), 1, 1]) for first in (0x00, 0x01, 0x52, 0x59, 0x5B, 0x7F, 0xFF)))

    def IgnoresTheBusWhereThereIsNone(self):
        self.assertEqual(self.robot.set_mode(0x90, 0x01), DONE)  # SPI
        self.robot.send_and_see(bytes([0x53, write_address(0), 1]))
        self.assertEqual(self.robot.version()[2], 0x90)

    def AReplyNeedNotBeWaitedFor(self):
        """Sends requests without waiting for replies: the reply comes; a request sent before that is answered
        afterwards or never; later requests are not affected."""
        first, second = bytes.fromhex("5a 03"), bytes([0x54, read_address(1), 16])
        for _ in range(5):
            self.robot.send(first)
            self.robot.send(second)
            self.assertRegex(self.robot.receive(8), rb"^[0-9]{8}$")
            self.robot.repeat(self.robot.taken, lambda bursts: "".join(bursts).replace(" ", "").endswith(second.hex()))
            self.robot.send_and_see(bytes.fromhex("5a 01"))
            got = b""
            while got[-3:][::2] != b"\x07\x70" or len(got) not in (3, 19):  # repeated if the answer was lost
                if not self.robot.waiting(0.5):
                    self.robot.send_and_see(bytes.fromhex("5a 01"))
                got += os.read(self.robot.terminal, 256)
                self.assertLessEqual(len(got), 19)
            if len(got) == 19:
                self.assertTrue(good_frame(1, got[:16]))

    def ATerminalMayBeClosedAndOpened(self):
        self.robot.close()
        self.robot.open()
        self.assertEqual(self.robot.version()[::2], b"\x07\x70", "the adapter remembers")
        self.assertRegex(self.robot.said, r"^/dev/pts/\d+ \(.*/robot\)\n$")
        self.assertEqual(self.robot.end(), 0)
        self.assertFalse(os.path.lexists(self.robot.link))
        self.robot.end = lambda: None

    # --- boards ---

    def caught_up(self, sequence):
        """Waits until all boards have taken this broadcast. Returns their statuses."""
        return self.robot.repeat(self.robot.statuses, lambda all: {status.sequence for status in all} == {sequence})

    def counters(self, board):
        result, payload = self.robot.request(board, question(COUNTERS))
        self.assertEqual(result, 0)
        return dict(zip(("bad", "late", "silences", "recoveries"), struct.unpack("<4H", payload[:8])))

    def faults(self, board):
        result, payload = self.robot.request(board, question(FAULTS))
        self.assertEqual(result, 0)
        return payload

    def boot(self, board):
        return struct.unpack("<H", self.robot.request(board, question(INFO))[1][8:10])[0]

    def MessagesAreThoseOfThePage(self):
        """Checks the page's examples, and the check values of its checksums."""
        self.assertEqual(crc16(b"123456789").hex(), "29b1")
        self.assertEqual(crc8(b"123456789").hex(), "f4")
        page = (ROOT / "docs/hardware/protocol.md").read_text()
        values = (500, *10 * [0], -500)
        for message in (cyclic(5, IMPEDANCE, values, arm=2, capture=True), EMERGENCY_STOP, setting(2, 1, 500),
                        question(INFO), action(0xE4, 0, 1000, 7)):
            self.assertIn("    " + message.hex(" "), page)
        frame = bytes.fromhex("05 03 7e 02 28 e8 03 20 90 c1 19 ff ff fd 00 47")
        self.assertIn(frame.hex(" "), page)
        self.assertTrue(good_frame(2, frame) and not good_frame(1, frame))

    def ABroadcastReachesAll(self):
        """Broadcasts with every writing command; the general call is a write to address 0."""
        self.assertTrue(self.robot.broadcast(1))
        self.caught_up(1)
        message = cyclic(2)
        self.assertEqual(self.robot.ask(bytes([0x55, 0x00, message[0], 28]) + message[1:], 1)[0] != 0, True)
        self.caught_up(2)
        message = cyclic(3)
        self.assertNotEqual(self.robot.ask(bytes([0x56, 0x00, *message[:2], 27]) + message[2:], 1), b"\0")
        self.caught_up(3)
        message = cyclic(4)
        self.assertEqual(self.robot.direct(0x01, 0x3F, 0x00, *message[:15], 0x3D, *message[15:], 0x03), b"")
        for status in self.caught_up(4):
            self.assertEqual((status.mode, status.wrong), (OFF, False))
            for motor in status.motors:
                # Taut or slack, the cables of a robot on the floor pull with less than 60 N (eq. 7 of the paper).
                self.assertTrue(0 <= 0.1567 * motor.reading_counts < 60 + 4.9363, motor.reading_counts)
                self.assertEqual((motor.set_point_counts, motor.duty), (0, 0))

    def EveryCommandReadsAStatus(self):
        self.assertTrue(self.robot.broadcast(7))
        self.caught_up(7)
        bad = self.counters(3)["bad"]
        for board in (0, 3, 5):
            address = read_address(board)
            whole = self.robot.read(address, 16)
            self.assertEqual(whole[0], 7)
            self.assertEqual(self.robot.ask(bytes([0x53, address]), 1), whole[:1])
            # Registers are bytes written before the read: here an invalid message.
            self.assertEqual(self.robot.ask(bytes([0x55, address, 0, 16]), 16), whole)
            self.assertEqual(self.robot.ask(bytes([0x56, address, 0, 0, 16]), 16), whole)
            self.assertEqual(self.robot.direct(0x01, 0x30, address, 0x2F, 0x03), whole, "without a NACK: as good")
            self.assertEqual(self.robot.direct(0x01, 0x30, address, 0x2E, 0x04, 0x20, 0x03), whole)
            self.assertEqual(self.robot.direct(0x01, 0x31, address - 1, 0x00, 0x02, 0x30, address, 0x2E, 0x04, 0x20,
                                               0x03), whole, "with a restart")
        self.assertEqual(self.counters(3)["bad"], bad + 3)

    def BoardsSayWhoTheyAre(self):
        for board in range(BOARDS):
            result, payload = self.robot.request(board, question(INFO))
            first, last, major, minor, parameters, boot, number = struct.unpack("<BBBBIHB", payload)
            self.assertEqual((result, first, last, number, boot), (0, 1, 1, board, 1), (major, minor))
            self.assertIn(f"`0x{parameters:x}`", (ROOT / "docs/hardware/parameters.md").read_text())
            faults = self.faults(board)
            self.assertEqual(faults[:3], b"\0\0\0", "well")
            self.assertEqual(faults[3], 1, "power came")
            # Computed winding temperatures equal the air's 25 degrees, once they are computed.
            self.robot.repeat(lambda: self.faults(board)[5:7], lambda temperatures: temperatures == b"\x19\x19")
            self.assertEqual(self.counters(board)["bad"], 0 if board < 5 else self.looks)

    def ParametersAreThoseOfThePage(self):
        page = (ROOT / "docs/hardware/parameters.md").read_text()
        motor, board = page.split("## Motor parameters")[1].split("## Board parameters")
        rows = 0
        for text, indices in ((motor, range(MOTORS)), (board, (2,))):
            for number, name, default in re.findall(r"^\| (\d+) \| `(\w+)` \| (\S+) \|", text, re.M):
                rows += 1
                value = self.robot.value(rows % BOARDS, int(number), indices[rows % len(indices)])
                self.assertEqual(value, struct.unpack("<f", struct.pack("<f", float(default)))[0], name)
        self.assertEqual(rows, 34)

    def ParametersCanBeSetAndAreChecked(self):
        for board, parameter, index, value in ((0, 18, 0, 40.0), (3, 18, 1, 30.0), (5, 1, 2, 11.5)):
            self.assertEqual(self.robot.request(board, setting(parameter, index, value)), (0, bytes(11)))
            self.assertEqual(self.robot.value(board, parameter, index), value)
        self.assertEqual(self.robot.value(0, 18, 1), 50.0, "of the other motor")
        self.assertEqual(self.robot.value(1, 18, 0), 50.0, "of another board")
        for parameter, index, value, result in ((18, 0, 111.0, 2), (18, 0, 0.5, 2), (18, 0, float("nan"), 2),
                                                (18, 0, float("inf"), 2), (24, 0, 1.0, 1), (10, 2, 1.0, 1), (0, 3, 1.0, 1)):
            self.assertEqual(self.robot.request(0, setting(parameter, index, value))[0], result, (parameter, index, value))
        self.assertEqual(self.robot.value(0, 18, 0), 40.0)
        self.assertEqual(self.robot.request(0, question(0xF7))[0], 1, "no such thing")

    def ActionsAreForOneBoot(self):
        self.assertTrue(self.robot.broadcast(1, clear=True))
        self.caught_up(1)
        boot = self.boot(4)
        self.assertEqual(self.robot.request(4, action(0xE4, 0, 1000, boot + 1))[0], 5)
        for motor, counts in enumerate((1000, -3)):
            self.assertEqual(self.robot.request(4, action(0xE4, motor, counts, boot))[0], 0)
        self.assertEqual(self.robot.request(4, action(0xE5, 0, 0, boot))[0], 1)
        self.assertTrue(self.robot.broadcast(2))
        all = self.caught_up(2)
        self.assertEqual([status.referenced for status in all], [False, False, False, False, True, False])
        self.assertAlmostEqual(all[4].motors[0].encoder, 1000, delta=100)
        self.assertEqual(self.faults(4)[4] & 0b11000, 0b11000)

    def ParametersAreKept(self):
        self.assertEqual(self.robot.request(2, setting(20, 1, 0.5))[0], 0)
        boot = self.boot(2)
        self.assertEqual(self.robot.request(2, action(0xE1, 2, 0, boot))[0], 0)
        self.robot.repeat(lambda: self.faults(2)[4], lambda bits: not bits & 0b100000)
        self.assertEqual(self.robot.request(2, action(0xE3, 2, 0, boot))[0], 0)
        self.assertEqual(self.robot.value(2, 20, 1), 1.0, "its default")
        self.assertEqual(self.robot.request(2, action(0xE2, 2, 0, boot))[0], 0)
        self.robot.repeat(lambda: self.robot.value(2, 20, 1), lambda value: value == 0.5)

    def MessagesThatAreWrongAreCountedAndDoNothingElse(self):
        self.assertTrue(self.robot.broadcast(1))
        self.caught_up(1)
        good = cyclic(2)
        other_version = bytes([0xC2]) + good[1:27]
        no_mode = cyclic(2, mode=6)
        at_first = {board: self.counters(board)["bad"] for board in (0, 5)}
        wrong = [good[:-1], good + b"\0", good[:28] + bytes([good[28] ^ 1]), bytes([0xC1, 3]) + good[2:],
                 other_version + crc16(other_version), no_mode, EMERGENCY_STOP[:3] + b"\0", EMERGENCY_STOP[:3], b"\xaa"]
        for count, message in enumerate(wrong, at_first[5] + 1):
            self.robot.write(0x00, message)
            self.robot.repeat(lambda: self.counters(5)["bad"], lambda bad: bad == count)
        for count, request in enumerate((question(INFO)[:3], question(INFO)[:3] + b"\0", setting(18, 0, 40.0)[:8], bytes(32),
                                         bytes(33), b"\xd4" + bytes(8)), at_first[5] + len(wrong) + 1):
            self.robot.write(write_address(5), request)
            self.robot.repeat(lambda: self.counters(5)["bad"], lambda bad: bad == count)
        self.assertEqual([status.sequence for status in self.robot.statuses()], BOARDS * [1])
        self.assertEqual(self.counters(0)["bad"], at_first[0] + len(wrong))
        self.assertEqual(self.robot.value(5, 18, 0), 50.0)

    def power(self):
        """Arms in two steps; the motors hold then."""
        self.assertTrue(self.robot.broadcast(1, OFF, arm=1, clear=True))
        self.caught_up(1)
        self.assertTrue(self.robot.broadcast(2, HOLD, arm=2))
        self.assertEqual({status.mode for status in self.caught_up(2)}, {HOLD})

    def PowerComesInTwoSteps(self):
        self.assertTrue(self.robot.broadcast(1, HOLD, arm=2, clear=True))
        for status in self.caught_up(1):
            self.assertEqual((status.mode, status.wrong), (OFF, True))
        self.assertEqual(self.faults(0)[2] & 16, 16, "not armed")
        self.assertTrue(self.robot.broadcast(2, OFF, arm=1, clear=True))
        self.caught_up(2)
        self.assertTrue(self.robot.broadcast(3, HOLD, arm=2))
        for status in self.caught_up(3):
            self.assertEqual((status.mode, status.wrong), (HOLD, False))
        self.assertEqual(self.faults(0)[4] & 0b100, 0b100, "armed")
        for sequence in range(4, 200, 2):  # until no gap of 100 ms occurs, after which boards only hold
            self.assertTrue(self.robot.broadcast(sequence, HOLD, arm=2, clear=True))
            self.assertTrue(self.robot.broadcast(sequence + 1, POSITION, arm=2))
            self.caught_up(sequence + 1)
            if self.faults(0)[2] & 8:
                return
        self.fail("a position without a reference is no fault")

    def AnEmergencyStopStopsAllUntilItIsCleared(self):
        self.power()
        self.assertTrue(self.robot.write(0x00, EMERGENCY_STOP))
        self.robot.repeat(lambda: self.faults(0)[4], lambda bits: bits & 0b110 == 0b010)  # stopped, not armed
        self.assertTrue(self.robot.broadcast(3, HOLD, arm=2))
        for status in self.caught_up(3):
            self.assertEqual((status.mode, [motor.duty for motor in status.motors]), (STOPPED, [0, 0]))
        self.assertTrue(self.robot.broadcast(4, OFF, arm=1, clear=True))
        self.assertEqual({status.mode for status in self.caught_up(4)}, {OFF})
        self.assertTrue(self.robot.broadcast(5, HOLD, arm=2))
        self.assertEqual({status.mode for status in self.caught_up(5)}, {HOLD})

    def SilenceIsNoticed(self):
        self.power()
        self.robot.repeat(lambda: self.faults(3)[4], lambda bits: bits & 1)
        self.assertGreaterEqual(self.counters(3)["silences"], 1)
        self.assertTrue(self.robot.broadcast(3, HOLD, arm=2))
        for status in self.caught_up(3):
            self.assertEqual((status.mode, status.timeout), (HOLD, True))
        self.assertTrue(self.robot.broadcast(4, HOLD, arm=2, clear=True))
        self.assertEqual({status.timeout for status in self.caught_up(4)}, {False})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], f"Client.{sys.argv[2]}"])
