"""The simulated rig's own parts: the world with its board, coils and robot, and the camera that looks at it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

from control.coils import CoilPair, CoilSet
from control.model import Pose
from control.simulation.board import TwinBoard, Winding
from control.simulation.emulated import EmulatedBoard, prepare
from control.simulation.lockstep import RemoteBoard
from control.simulation.plants import build_plant
from control.simulation.wiring import Wiring
from control.simulation.world import Board, World
from server.calibration.optics import assumed_model
from server.coil_sections import Coil
from server.settings import MM, MS, RigFile
from server.settings_in_si import registration_of
from vision.simulated.camera import AsFastAsItGoes, Pace, RealTime, SceneSettings, SyntheticCamera
from vision.simulated.scenes import SCENES

TOO_BUSY = 0.07
"""A computer that simulates nothing for this long, s, has stopped the simulated world rather than made the rig late:
with the camera's 35 ms and one frame, a longer gap would make a frame too old and a command expire."""

_names = (f"rig-{number}" for number in itertools.count(1))


def simulated_world(settings: RigFile, coils: CoilSet, realtime: bool) -> tuple[World, str]:
    """The simulated world and the name of the port to its board."""
    simulation = settings.simulation
    start = Pose(
        simulation.start_x_mm * MM, simulation.start_y_mm * MM, math.radians(simulation.start_heading_deg)
    )
    plant = build_plant(simulation.plant_choice, settings.robot.length_mm * MM, start, simulation.seed)
    true_coils, wiring = _true_coils(settings, coils), Wiring(simulation.wiring)
    board, port = _board(settings, realtime)
    return World(board, plant, true_coils, wiring=wiring), port


def _board(settings: RigFile, realtime: bool) -> tuple[Board, str]:
    coils = settings.coils
    windings = _winding(coils.x), _winding(coils.y), _winding(coils.z)
    boot_id = settings.simulation.seed % 0xFFFF + 1
    match settings.simulation.board:
        case "twin":
            name = next(_names)
            return TwinBoard(name, windings, coils.supply_V, boot_id=boot_id), f"sim://{name}"
        case "emulated":
            board = EmulatedBoard(prepare(), windings, coils.supply_V, realtime, boot_id)
            return board, board.port
        case url:
            return RemoteBoard(url, realtime=realtime), settings.link.port


def _winding(coil: Coil) -> Winding:
    return Winding(coil.resistance_ohm, coil.inductance_mH * 1e-3)


def _true_coils(settings: RigFile, coils: CoilSet) -> CoilSet:
    """The simulated coils: as the rig file has them but for what the simulation says of gains and place."""
    gains, section = settings.simulation.field_gain, settings.simulation.registration
    if gains is None and section is None:
        return coils
    registration = coils.registration if section is None else registration_of(section)
    pairs = coils.pairs if gains is None else _with_gains(coils.pairs, gains)
    return CoilSet(pairs, coils.workspace, registration)


def _with_gains(pairs: Sequence[CoilPair], gains: list[float]) -> list[CoilPair]:
    return [replace(pair, gain=gain) for pair, gain in zip(pairs, gains, strict=True)]


def _pace(settings: RigFile, realtime: bool) -> Pace:
    if not realtime:
        return AsFastAsItGoes()
    return RealTime(TOO_BUSY if settings.simulation.board == "twin" else None)


def simulated_camera(settings: RigFile, world: World, realtime: bool) -> SyntheticCamera:
    """What looks at the world, through the optics that the rig file assumes."""
    staged = SCENES[settings.simulation.scene]
    scene = SceneSettings(
        rate=settings.camera.rate_Hz,
        latency=settings.simulation.latency_ms * MS,
        assumed_latency=settings.camera.latency_ms * MS if settings.simulation.stamps == "arrival" else None,
        noise=settings.simulation.noise,
        blur=settings.simulation.blur_px,
        seed=settings.simulation.seed,
        length=settings.robot.body_length_mm * MM,
        width=settings.robot.body_width_mm * MM,
        height=settings.robot.body_height_mm * MM,
    )
    return SyntheticCamera(world, assumed_model(settings.camera), scene, _pace(settings, realtime), staged)
