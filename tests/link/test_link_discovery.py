"""Which boards are there, who answers on a port, and what stands in the way of opening it."""

from __future__ import annotations

import errno
import fcntl
import grp
import os
import pty
import struct
import termios
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from link_bench import CONFIGURATION, Rig, board, rig, until

from control.link import opening, wire
from control.link.conversion import LinkError
from control.link.discovery import AUTO, TheOneBoard, UsbPort, find_boards, same_device, usb_ports
from control.link.messages import Banner, Hello
from control.link.opening import (
    PortError,
    Trouble,
    is_pseudo_terminal,
    make_exclusive,
    open_serial,
    permission_advice,
    trouble_of,
)
from control.link.port import Link
from control.link.probe import PATIENCE, Inquiry, PortState, probe

UNO = UsbPort("/dev/ttyACM0", "2341:0043", "7583", "ttyACM0", "/dev/serial/by-id/usb-Arduino_7583-if00")
CLONE = UsbPort("/dev/ttyUSB0", "1a86:7523", "", "USB2.0-Serial")
PRINTER = UsbPort("/dev/ttyACM4", "04b8:0202", "1", "Receipt printer")
IMPATIENT = 0.4


@pytest.fixture
def bench() -> Iterator[Rig]:
    with rig() as made:
        yield made


@contextmanager
def speaking(speak: Callable[[int, bytes], None]) -> Iterator[str]:
    """A terminal with something else than our board behind it: `speak` hears each piece of bytes."""
    theirs, ours = pty.openpty()
    tty.setraw(ours)
    os.set_blocking(theirs, False)
    ending = threading.Event()

    def listen() -> None:
        while not ending.is_set():
            try:
                speak(theirs, os.read(theirs, 4096))
            except BlockingIOError:
                ending.wait(0.002)

    thread = threading.Thread(target=listen)
    thread.start()
    try:
        yield os.ttyname(ours)
    finally:
        ending.set()
        thread.join()
        os.close(theirs)
        os.close(ours)


# ---- which boards are plugged in


def test_auto_is_the_one_board_that_is_plugged_in() -> None:
    assert TheOneBoard(lambda: [UNO])() == "/dev/ttyACM0"
    assert TheOneBoard(lambda: [PRINTER, CLONE])() == "/dev/ttyUSB0"


def test_auto_without_a_board_says_what_there_is_instead() -> None:
    with pytest.raises(PortError, match=r"no board is connected.*Receipt printer.*link.port"):
        TheOneBoard(lambda: [PRINTER])()
    with pytest.raises(PortError, match="no serial port on USB at all"):
        TheOneBoard(lambda: [])()


def test_auto_with_several_boards_lists_them_by_their_lasting_names() -> None:
    with pytest.raises(PortError, match=r"2 boards.*by-id/usb-Arduino_7583-if00.*ttyUSB0.*Name one"):
        TheOneBoard(lambda: [UNO, CLONE])()


def test_auto_finds_the_board_that_it_used_under_another_name() -> None:
    there = [UNO]
    locate = TheOneBoard(lambda: there)
    locate()
    there[:] = [CLONE, UsbPort("/dev/ttyACM1", UNO.usb_id, UNO.serial_number)]
    assert locate() == "/dev/ttyACM1"


def test_auto_does_not_take_another_board_for_the_one_that_it_used() -> None:
    """Its coils may be another rig's, and opening its port would reset it."""
    there = [UNO]
    locate = TheOneBoard(lambda: there)
    locate()
    for others in ([CLONE], [UsbPort("/dev/ttyACM0", UNO.usb_id, "another")], [CLONE, CLONE]):
        there[:] = others
        with pytest.raises(
            PortError, match=r"by-id/usb-Arduino_7583-if00.* is not connected any more.*link.port"
        ):
            locate()
    there[:] = [CLONE, UNO]
    assert locate() == UNO.device


def test_auto_does_not_guess_among_boards_without_a_serial_number() -> None:
    there = [CLONE]
    locate = TheOneBoard(lambda: there)
    locate()
    there[:] = [UNO, UsbPort("/dev/ttyUSB1", CLONE.usb_id)]
    with pytest.raises(PortError, match="2 boards"):
        locate()


def test_every_port_that_is_listed_is_on_usb_and_has_a_device() -> None:
    for port in usb_ports():
        assert Path(port.device).exists()
        assert len(port.usb_id) == 9


def test_a_port_in_use_is_listed_and_never_asked() -> None:
    in_use = [port.device for port in usb_ports()]
    assert all(found.findings.state is PortState.BUSY for found in find_boards(True, in_use))


def test_a_lasting_name_is_the_same_device(tmp_path: Path) -> None:
    lasting = tmp_path / "usb-Arduino_7583-if00"
    lasting.symlink_to("/dev/null")
    assert same_device(str(lasting), "/dev/null")
    assert not same_device(str(lasting), "/dev/zero")


def test_a_board_that_comes_back_under_another_name_is_found_and_stays_at_rest(tmp_path: Path) -> None:
    """Its lasting name leads to another terminal after it was plugged in again."""
    lasting = tmp_path / "usb-Arduino_7583-if00"
    with board() as (first, _), board() as (second, monitor):
        lasting.symlink_to(first)
        link = Link(str(lasting), 500000, CONFIGURATION, time.monotonic)
        link.open()
        assert until(lambda: link.poll() is not None)
        lasting.unlink()
        lasting.symlink_to(second)
        link._lose("unplugged")
        assert until(lambda: link.poll() is not None)
        assert link.status.counts.reconnects == 1
        assert monitor.state()["boot_id"] == link.status.boot_id
        assert all(sample.duty == (0, 0, 0) for sample in monitor.take())
        link.close()


def test_a_link_to_auto_opens_the_board_that_is_there(bench: Rig) -> None:
    """The list of ports is given, since no board is plugged into a computer that runs tests."""
    link = Link(AUTO, 500000, CONFIGURATION, lambda: bench.now)
    link._locate = TheOneBoard(lambda: [UsbPort(bench.link.port, "2341:0043", "1")])
    link.open()
    assert link.status.port == bench.link.port
    link.close()


# ---- who is there


def test_our_board_says_who_it_is_and_is_left_at_zero() -> None:
    with board("--boot-id", "77") as (port, monitor):
        findings = probe(port)
        assert findings.state is PortState.OURS
        assert findings.identity is not None
        assert findings.identity.firmware in findings.message
        assert findings.identity.protocol == wire.PROTOCOL_VERSION
        assert findings.identity.boot_id == 77
        assert findings.identity.reset_cause == "power on"
        assert findings.identity.configuration_hash == 0
        assert 0.0 < findings.identity.round_trip < PATIENCE
        assert all(sample.duty == (0, 0, 0) for sample in monitor.take())


def chatter(end: int, _: bytes) -> None:
    os.write(end, b"Grbl 1.1h ['$' for help]\r\n")


def test_a_device_that_chatters_is_another_firmware() -> None:
    with speaking(chatter) as port:
        findings = probe(port, patience=IMPATIENT)
    assert findings.state is PortState.FOREIGN
    assert "bytes came" in findings.message
    assert "firmware flash" in findings.message


def test_a_device_that_says_nothing_is_no_board_of_ours() -> None:
    with speaking(lambda *_: None) as port:
        findings = probe(port, patience=IMPATIENT)
    assert findings.state is PortState.FOREIGN
    assert "nothing answers" in findings.message


def test_a_board_with_another_version_is_named_with_what_to_flash() -> None:
    decoder = wire.Decoder()

    def answer(end: int, heard: bytes) -> None:
        for packet in decoder.feed(heard):
            os.write(end, wire.encode(Banner((7, 8, 9), 1, 0), packet.sequence, 5, version=200))

    with speaking(answer) as port:
        findings = probe(port)
    assert findings.state is PortState.OTHER_VERSION
    assert "firmware 7.8.9 speaks protocol version 200" in findings.message
    assert "firmware flash" in findings.message


def test_an_uno_that_resets_when_it_is_opened_is_waited_for() -> None:
    """Two seconds of bootloader: garbage for an answer, then the boot's banner, then ours."""
    inquiry = Inquiry()
    hellos = []
    for tick in range(500):
        now = tick * 0.005
        hello = inquiry.due(now)
        if hello:
            hellos.append(now)
        if now < 2.0:
            inquiry.receive(b"\xf8\x00\x1e" if hello else b"", now)
        elif now == 2.0:
            inquiry.receive(wire.encode(Banner((0, 1, 0), 1, 0), 0, 6), now)
        elif hello:
            asked = wire.Decoder().feed(hello)[0]
            assert asked.message == Hello()
            inquiry.receive(wire.encode(Banner((0, 1, 0), 1, 0), asked.sequence, 6), now + 0.002)
            break
    assert inquiry.findings.state is PortState.OURS
    assert hellos == pytest.approx([0.3 * k for k in range(7)] + [2.005], abs=0.02)
    assert inquiry.due(99.0) == b""


def test_a_banner_that_answers_somebody_else_is_not_taken() -> None:
    inquiry = Inquiry()
    inquiry.due(0.0)
    inquiry.receive(wire.encode(Banner((0, 1, 0), 9, 0), 4711, 6), 0.01)
    assert inquiry.identity is None
    inquiry.receive(wire.encode(Banner((0, 1, 0), 9, 0), 1, 6), 0.01)
    assert inquiry.identity is not None
    assert inquiry.identity.reset_cause == "unknown (9)"


def test_a_port_that_a_link_has_open_is_busy() -> None:
    with board() as (port, _):
        link = Link(port, 500000, CONFIGURATION, time.monotonic)
        link.open()
        assert probe(port).state is PortState.BUSY
        link.close()
        assert probe(port).state is PortState.OURS


def test_a_port_that_is_not_there_is_missing() -> None:
    assert probe("/dev/ttyACM99").state is PortState.MISSING


def test_a_port_that_hangs_up_while_it_is_asked_has_failed() -> None:
    theirs, ours = pty.openpty()
    tty.setraw(ours)
    name = os.ttyname(ours)
    hang_up = threading.Timer(0.1, lambda: (os.close(theirs), os.close(ours)))
    hang_up.start()
    findings = probe(name, patience=5.0)
    hang_up.join()
    assert findings.state is PortState.FAILED
    assert "failed while it was asked" in findings.message


# ---- what stands in the way


@pytest.mark.parametrize(
    ("number", "trouble"),
    [
        (errno.EBUSY, Trouble.BUSY),
        (errno.EAGAIN, Trouble.BUSY),
        (errno.EACCES, Trouble.FORBIDDEN),
        (errno.EPERM, Trouble.FORBIDDEN),
        (errno.ENOENT, Trouble.MISSING),
        (errno.ENODEV, Trouble.MISSING),
        (errno.ENXIO, Trouble.MISSING),
        (errno.EIO, Trouble.FAILED),
    ],
)
def test_each_errno_is_a_trouble_that_people_know(number: int, trouble: Trouble) -> None:
    assert trouble_of(OSError(number, "so it is")) is trouble


def test_a_port_that_one_may_not_use_names_the_group_that_may(tmp_path: Path) -> None:
    device = tmp_path / "ttyACM0"
    device.touch()
    group = grp.getgrgid(device.stat().st_gid).gr_name
    assert f"usermod -aG {group} $USER" in permission_advice(str(device))
    assert "usermod -aG dialout $USER" in permission_advice(str(tmp_path / "gone"))


def test_an_error_names_the_port_and_what_to_do() -> None:
    with pytest.raises(LinkError, match=r"cannot open /dev/ttyACM99 at 500000 baud.*pivotrig doctor"):
        open_serial("/dev/ttyACM99", 500000)


def test_a_terminal_made_exclusive_is_so_until_it_is_closed() -> None:
    theirs, ours = pty.openpty()
    make_exclusive(ours)
    mark = struct.unpack("i", fcntl.ioctl(ours, _GET_EXCLUSIVE, b"\0" * 4))[0]
    os.close(theirs)
    os.close(ours)
    assert mark == 1


_GET_EXCLUSIVE = getattr(termios, "TIOCGEXCL", 0x80045440)
"""Not in Python 3.11's termios."""


def test_only_pseudo_terminals_count_as_such() -> None:
    theirs, ours = pty.openpty()
    assert is_pseudo_terminal(ours)
    os.close(theirs)
    os.close(ours)
    with open("/dev/null") as null:
        assert not is_pseudo_terminal(null.fileno())


def test_a_port_that_goes_while_it_is_opened_is_a_failed_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plug with a loose contact: the terminal opens, and hangs up before it is ours alone."""
    theirs, ours = pty.openpty()
    tty.setraw(ours)
    monkeypatch.setattr(opening, "is_pseudo_terminal", lambda _: os.close(theirs))
    files = len(os.listdir("/proc/self/fd"))
    with pytest.raises(PortError, match="Input/output error"):
        open_serial(os.ttyname(ours), 500000)
    os.close(ours)
    assert len(os.listdir("/proc/self/fd")) == files - 2
