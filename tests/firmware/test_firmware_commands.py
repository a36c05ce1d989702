"""`pivotrig firmware build | flash | emulate | cycles`, as a person would use them."""

from __future__ import annotations

import json
import os
import re
import signal
import stat
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from board_contact import process_of
from typer.testing import CliRunner, Result

from control.firmware.flashing import Flashing
from control.link.opening import open_serial
from control.link.probe import BAUD
from control.simulation.lockstep import RemoteBoard
from server.cli import app
from server.commands.firmware import MOST_SHARE
from server.signals import handled
from tests.processes import poll, started

AVRDUDE = """#!/bin/sh
echo "$@" >> "{log}"
echo "avrdude: stand-in" >&2
exit {status}
"""


def told(*arguments: str, answer: str = "") -> Result:
    return CliRunner().invoke(app, ["firmware", *arguments], input=answer)


class Writer:
    """A stand-in for avrdude, first in the path, that writes down how it was called."""

    def __init__(self, folder: Path) -> None:
        self._program = folder / "avrdude"
        self._log = folder / "calls"
        self.answers(0)

    def answers(self, status: int) -> None:
        self._program.write_text(AVRDUDE.format(log=self._log, status=status))
        self._program.chmod(self._program.stat().st_mode | stat.S_IXUSR)

    @property
    def calls(self) -> list[str]:
        return self._log.read_text().splitlines() if self._log.exists() else []


@pytest.fixture
def writer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Writer:
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    return Writer(folder)


@pytest.fixture
def port() -> Iterator[str]:
    """A serial port that somebody could have."""
    with process_of("avr") as (serial, _):
        yield serial


def test_build_prints_what_the_firmware_takes_and_it_fits_with_room_to_spare(tmp_path: Path) -> None:
    done = told("build", "--folder", str(tmp_path))
    assert done.exit_code == 0
    assert re.search(r"^flash +\d+ +32768 +\d+\.\d%$", done.stdout, re.MULTILINE)
    assert re.search(r"^RAM +\d+ +2048 +\d+\.\d%$", done.stdout, re.MULTILINE)
    figures = json.loads(told("build", "--folder", str(tmp_path), "--json").stdout)
    assert figures["flash_share"] <= 0.5
    assert figures["ram_share"] <= 0.6
    assert Path(figures["hex"]).read_text().startswith(":")


def test_the_worst_case_of_the_interrupt_leaves_two_fifths_of_its_millisecond() -> None:
    done = told("cycles", "--json")
    assert done.exit_code == 0, done.stderr
    for load in json.loads(done.stdout).values():
        assert load["interrupt_worst_share"] <= MOST_SHARE
        assert load["ticks"] >= 990
        assert load["lost_bytes"] == 0


def test_flash_shows_what_it_will_do_and_asks_first(writer: Writer, port: str, tmp_path: Path) -> None:
    done = told("flash", "--port", port, "--folder", str(tmp_path), answer="n\n")
    assert done.exit_code == 1
    assert port in done.stderr
    assert "switch the coil supply off" in done.stderr
    assert "nothing was written" in done.stderr
    assert writer.calls == []


def test_flash_writes_after_a_yes(writer: Writer, port: str, tmp_path: Path) -> None:
    done = told("flash", "--port", port, "--folder", str(tmp_path), answer="y\n")
    assert done.exit_code == 0, done.stderr
    assert "written and verified" in done.stdout
    flashing = Flashing(tmp_path / "pivotrig.hex", port)
    assert writer.calls == [" ".join(flashing.command("avrdude")[1:])]
    assert f"-P {port} -b 115200 -D -U flash:w:" in writer.calls[0]


def test_another_programmer_may_erase_the_chip(tmp_path: Path) -> None:
    command = Flashing(tmp_path / "x.hex", "usb", "usbasp").command("avrdude")
    assert "-D" not in command
    assert "-b" not in command
    assert command[command.index("-c") + 1] == "usbasp"


def test_flash_writes_with_a_programmer_that_has_no_serial_port(writer: Writer, tmp_path: Path) -> None:
    arguments = ("--programmer", "usbasp", "--port", "usb", "--yes")
    done = told("flash", *arguments, "--folder", str(tmp_path))
    assert done.exit_code == 0, done.stderr
    assert "-c usbasp -P usb -U flash:w:" in writer.calls[0]


def test_flash_says_what_avrdude_said_when_it_failed(writer: Writer, port: str, tmp_path: Path) -> None:
    writer.answers(3)
    done = told("flash", "--port", port, "--folder", str(tmp_path), "--yes")
    assert done.exit_code == 1
    assert "avrdude failed with status 3" in done.stderr
    assert "stand-in" in done.stderr


def test_flash_refuses_a_port_that_is_in_use(writer: Writer, port: str, tmp_path: Path) -> None:
    with closing(open_serial(port, BAUD)):
        done = told("flash", "--port", port, "--folder", str(tmp_path), "--yes")
    assert done.exit_code == 3
    assert port in done.stderr
    assert writer.calls == []


def test_flash_without_a_board_asks_for_a_port(writer: Writer, tmp_path: Path) -> None:
    done = told("flash", "--folder", str(tmp_path), "--yes")
    assert done.exit_code == 2
    assert "--port" in done.stderr
    assert writer.calls == []


def test_flash_without_avrdude_says_what_to_install(
    port: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tools = tmp_path / "tools"
    tools.mkdir()
    for folder in os.environ["PATH"].split(os.pathsep):
        for tool in Path(folder).glob("*") if Path(folder).is_dir() else ():
            if tool.name != "avrdude" and not (tools / tool.name).exists():
                (tools / tool.name).symlink_to(tool)
    monkeypatch.setenv("PATH", str(tools))
    done = told("flash", "--port", port, "--folder", str(tmp_path / "built"), "--yes")
    assert done.exit_code == 1
    assert "apt-get install avrdude" in done.stderr


@pytest.mark.parametrize("way", [signal.SIGINT, signal.SIGTERM])
def test_emulate_offers_a_board_until_it_is_interrupted(way: signal.Signals) -> None:
    with started("server", "firmware", "emulate") as (process, line):
        found = re.fullmatch(r"board: serial=(\S+) control=(tcp://\S+)", line)
        assert found is not None, line
        with closing(RemoteBoard(found[2], realtime=False)) as board:
            assert board.state()["firmware"] == "avr"
            process.send_signal(way)
            assert process.wait(10) == (0 if way is signal.SIGINT else -signal.SIGTERM)
        poll(lambda: refuses(found[2]), bool)


def test_emulate_is_interrupted_also_where_its_parent_ignores_interrupts() -> None:
    """A shell starts what runs in the background like that."""
    with handled({signal.SIGINT: signal.SIG_IGN}), started("server", "firmware", "emulate") as (process, _):
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == 0


def refuses(control: str) -> bool:
    try:
        RemoteBoard(control, realtime=False).close()
    except ConnectionRefusedError:
        return True
    return False
