"""The emulated board as a child process: it is built when needed, and never outlives who started it."""

from __future__ import annotations

import os
import signal
import time
from contextlib import closing
from importlib.metadata import version
from pathlib import Path

import pytest
from board_contact import process_of

from control.firmware.build import BuildError
from control.firmware.build import build as build_firmware
from control.firmware.emulator.build import EmulatorMissing, build_emulator, is_stale
from control.simulation.bridges import Winding
from control.simulation.emulated import (
    EmulatedBoard,
    Emulation,
    EmulationFailed,
    EmulatorProcess,
    build_folder,
    prepare,
)
from control.simulation.lockstep import RemoteBoard
from tests.processes import started

COILS = (Winding(2.5, 0.125), Winding(2.0, 0.055), Winding(1.5, 0.014))

PARENT = """
import time
from contextlib import closing
from control.simulation.bridges import Winding
from control.simulation.emulated import EmulatedBoard, prepare
coil = Winding(2.0, 0.05)
with closing(EmulatedBoard(prepare(), (coil, coil, coil), 24.0, realtime=False)) as board:
    print(board.pid, flush=True)
    time.sleep(60)
"""


def is_alive(pid: int) -> bool:
    """A child whose parent is gone is reaped by somebody else, so a zombie counts as gone."""
    try:
        return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except FileNotFoundError:
        return False


def ends(pid: int, within: float = 5.0) -> bool:
    until = time.monotonic() + within
    while is_alive(pid) and time.monotonic() < until:
        time.sleep(0.01)
    return not is_alive(pid)


def test_the_emulator_ends_with_its_parent_even_when_that_is_killed(tmp_path: Path) -> None:
    (tmp_path / "parent.py").write_text(PARENT)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(tmp_path), os.getcwd()))}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", environment["PYTHONPATH"])
        with started("parent") as (parent, line):
            assert is_alive(int(line))
            parent.send_signal(signal.SIGKILL)
            assert ends(int(line))


def test_a_board_that_is_closed_leaves_no_process() -> None:
    board = EmulatedBoard(prepare(), COILS, 24.0, realtime=True)
    board.close()
    assert not is_alive(board.pid)


def test_the_emulator_ends_soon_after_its_last_client() -> None:
    with process_of("avr", "--linger", "0.3") as (_, control):
        with closing(RemoteBoard(control, realtime=True)) as client:
            assert client.state()["mode"] == "run"
        time.sleep(0.1)
        with closing(RemoteBoard(control, realtime=True)) as client:
            assert client.state()["mode"] == "run"
        time.sleep(1.5)
        with pytest.raises(ConnectionRefusedError):
            RemoteBoard(control, realtime=True)


def test_an_emulated_board_keeps_real_time() -> None:
    with closing(EmulatedBoard(prepare(), COILS, 24.0, realtime=True)) as board:
        begin = time.monotonic(), int(str(board.state()["time_ms"]))
        time.sleep(0.5)
        passed = int(str(board.state()["time_ms"])) - begin[1]
        assert passed * 1e-3 <= time.monotonic() - begin[0] + 0.005
        assert passed > 300


@pytest.mark.parametrize("boot_id", [1, 2, 700, 65535])
def test_the_first_boot_has_the_boot_id_that_was_asked_for_and_the_next_one_the_next(boot_id: int) -> None:
    with (
        process_of("avr", "--boot-id", str(boot_id)) as (_, control),
        closing(RemoteBoard(control, realtime=False)) as board,
    ):
        board.advance(20)
        assert board.state()["boot_id"] == boot_id
        board.reset()
        board.advance(20)
        assert board.state()["boot_id"] == boot_id % 65535 + 1


def test_what_is_no_firmware_is_refused(tmp_path: Path) -> None:
    nothing = tmp_path / "nothing.elf"
    nothing.write_text("nothing")
    with pytest.raises(EmulationFailed, match="did not start"):
        EmulatorProcess(Emulation(prepare().program, nothing))


@pytest.mark.parametrize(
    "option",
    [["--supply-V", "66"], ["--linger", "nan"], ["--control-port", "70000"], ["--boot-id", "0"], ["x"]],
)
def test_an_option_out_of_range_is_refused(option: list[str]) -> None:
    with pytest.raises(EmulationFailed, match="did not start"):
        EmulatorProcess(prepare(), *option)


def test_what_is_older_than_its_sources_is_built_anew(tmp_path: Path) -> None:
    product, source = tmp_path / "product", tmp_path / "source"
    source.write_text("")
    assert is_stale(product, [source])
    product.write_text("")
    os.utime(source, (1.0, 1.0))
    assert not is_stale(product, [source])
    os.utime(product, (0.5, 0.5))
    assert is_stale(product, [source])


def test_an_installed_program_runs_nothing_that_another_version_has_built(tmp_path: Path) -> None:
    assert version("pivotrig") in build_folder(tmp_path).parts
    (tmp_path / "pyproject.toml").touch()
    assert build_folder(tmp_path) == tmp_path / "build" / "firmware"


def test_a_missing_compiler_is_named_with_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(EmulatorMissing, match="apt-get install gcc"):
        build_emulator(tmp_path / "emulator")
    with pytest.raises(BuildError, match="gcc-avr"):
        build_firmware(tmp_path / "firmware")


def test_both_programs_are_built_in_an_empty_folder(tmp_path: Path) -> None:
    emulation = prepare(tmp_path)
    assert emulation.elf.is_file()
    assert os.access(emulation.program, os.X_OK)
    made = emulation.program.stat().st_mtime_ns, emulation.elf.stat().st_mtime_ns
    again = prepare(tmp_path)
    assert (again.program.stat().st_mtime_ns, again.elf.stat().st_mtime_ns) == made
