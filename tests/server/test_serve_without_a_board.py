"""A real rig whose board is not plugged in: its page opens, disarmed, says why, and finds the board later (row 9)."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.processes import ServerRefused, served
from tests.real_rig import real_rig


def without_its_board(rig_file: Path, cable: Path) -> Path:
    """Lets the rig file name a port that is not there yet; returns where the board really is."""
    text = rig_file.read_text()
    port = text.split('port = "')[1].split('"')[0]
    rig_file.write_text(text.replace(port, str(cable)))
    return Path(port)


def test_a_board_that_is_not_plugged_in_is_waited_for_and_arms_nothing(tmp_path: Path) -> None:
    """When the board's cable is out, `pivotrig serve` opens the page all the same; plugged in, the board is found
    and greeted, and the rig is still disarmed."""
    cable = tmp_path / "cable"
    with real_rig(tmp_path) as rig_file:
        board = without_its_board(rig_file, cable)
        with served(tmp_path / "data", "--rig", str(rig_file)) as server:
            state = server.until(lambda state: "link" in [fault["code"] for fault in state["faults"]])
            assert state["rig"] == "disarmed"
            (reason,) = (fault["message"] for fault in state["faults"] if fault["code"] == "link")
            assert str(cable) in reason
            with pytest.raises(ServerRefused, match="409"):
                server.post("/arm", {"consent": True})
            cable.symlink_to(board)
            state = server.until(lambda state: state["link"]["state"] == "ready")
            assert state["rig"] == "disarmed"
            assert "link" not in [fault["code"] for fault in state["faults"]]


def test_a_rig_without_its_board_can_be_changed_and_its_port_set_right(tmp_path: Path) -> None:
    """Without a board, everything else can be set up; the right port from the page is all that is needed then."""
    with real_rig(tmp_path) as rig_file:
        board = without_its_board(rig_file, tmp_path / "nothing")
        with served(tmp_path / "data", "--rig", str(rig_file)) as server:
            server.send("PATCH", "/rig", {"limits": {"field_mT": 12.0}})
            assert server.get("/rig")["limits"]["field_mT"] == 12.0
            assert server.get("/state")["rig"] == "disarmed"
            server.send("PATCH", "/rig", {"link": {"port": str(board)}})
            server.until(lambda state: state["link"]["state"] == "ready")
            with pytest.raises(ServerRefused, match="is as it was"):
                server.send("PATCH", "/rig", {"link": {"port": str(tmp_path / "nothing")}})
            assert server.get("/rig")["link"]["port"] == str(board)
            server.until(lambda state: state["link"]["state"] == "ready")
