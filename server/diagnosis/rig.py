"""The rig's devices, opened as the program opens them: a simulated rig's through the same code as a real one's."""

from __future__ import annotations

import time
from collections.abc import Iterator

from control.link.discovery import AUTO, TheOneBoard
from control.link.opening import PortError
from control.link.port import Link
from control.parts import Camera
from server.assembly import build_machine
from server.diagnosis import board, camera, latency
from server.diagnosis.check import Check, problem
from server.diagnosis.ports import is_device
from server.exchange import without_traffic_log
from server.settings import RigFile
from server.settings_in_si import board_configuration, camera_request
from vision.sources.listing import find_cameras
from vision.sources.opening import CameraError, open_camera

PAUSE = 5e-3
"""Between two looks at a real port, s."""


def examine(settings: RigFile) -> Iterator[Check]:
    yield camera.listed(find_cameras())
    if settings.is_simulated:
        yield from simulated(settings)
        return
    yield from real_board(settings)
    yield from real_camera(settings)


def simulated(settings: RigFile) -> Iterator[Check]:
    """Camera and board share a world, whose time passes while the camera is read."""
    try:
        machine = build_machine(without_traffic_log(settings), realtime=False)
    except (ValueError, OSError) as error:
        yield problem("simulation", str(error), "correct [simulation] in the rig file, or start its board")
        return
    try:
        yield from camera.examine(machine.camera, settings)
        yield from board.examine(
            machine.link, machine.camera.now, lambda: pass_time(machine.camera), settings
        )
    finally:
        machine.close()


def pass_time(simulated_camera: Camera) -> None:
    simulated_camera.read(PAUSE)


def real_board(settings: RigFile) -> Iterator[Check]:
    try:
        port = TheOneBoard()() if settings.link.port == AUTO else settings.link.port
    except PortError as error:
        yield problem("board", str(error), "connect it, or name its port as link.port in the rig file")
        return
    if is_device(port):
        asked = board.identify(port, settings.link.baud)
        yield asked
        if asked.level == "problem":
            return
    link = Link(port, settings.link.baud, board_configuration(settings), time.monotonic)
    yield from board.examine(link, time.monotonic, lambda: time.sleep(PAUSE), settings)


def real_camera(settings: RigFile) -> Iterator[Check]:
    try:
        opened = open_camera(settings.camera.uri, camera_request(settings.camera))
    except CameraError as error:
        yield camera.cannot_be_opened(error)
        return
    try:
        opened.require()
        yield from camera.examine(opened, settings)
        yield latency.examine(settings)
    except CameraError as error:
        yield camera.cannot_be_opened(error)
    finally:
        opened.close()
