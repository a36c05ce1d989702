"""The traffic log as an operator switches it on: one line in the rig file."""

from __future__ import annotations

from pathlib import Path

from control.link.messages import Banner
from control.link.traffic import Kind, read_log
from control.link.wire import Decoder
from server.assembly import build_machine
from server.settings import RigFile
from tests.processes import served


def test_a_server_logs_the_lines_traffic_in_its_data_folder_when_told_to(tmp_path: Path) -> None:
    rig_file = tmp_path / "rig.toml"
    rig_file.write_text("[link]\ntraffic_log = true\n")
    data = tmp_path / "data"
    with served(data, "--sim", "--rig", str(rig_file)) as server:
        server.until(lambda state: state["link"]["state"] == "ready")
        server.process.terminate()
        server.process.wait(10)
    entries = list(read_log(data / "link-traffic.log"))
    heard = Decoder().feed(b"".join(entry.data for entry in entries if entry.kind is Kind.FROM_BOARD))
    assert any(isinstance(packet.message, Banner) for packet in heard)


def test_without_being_told_nothing_is_logged(tmp_path: Path) -> None:
    machine = build_machine(RigFile(), realtime=False, data=tmp_path)
    machine.open()
    machine.close()
    assert list(tmp_path.iterdir()) == []
