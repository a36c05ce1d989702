"""From a rig file to a working rig: the one place that knows which parts are simulated."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from control.actuation import Actuation, ActuationSettings
from control.coils import CoilPair, CoilSet
from control.estimator import EstimatorSettings
from control.field_model import FieldModel
from control.gait_model import GaitModel
from control.link.conversion import Configuration
from control.link.port import Link
from control.loop import ControlLoop
from control.model import Pose, body_tilt
from control.parts import Camera, Parts
from control.perception import Perception
from control.safety import Limits
from control.simulation.board import TwinBoard, Winding
from control.simulation.lockstep import RemoteBoard
from control.simulation.plant import build_plant
from control.simulation.world import Board, World
from server.settings import MM, MS, Coil, RigFile
from vision.calibration import CameraModel
from vision.cameras import open_camera
from vision.detection import ColourRange, RegionFilter
from vision.synthetic import AsFastAsItGoes, Pace, RealTime, SceneSettings, SyntheticCamera
from vision.tracking import ColourTracker, TrackerSettings

FULL_FIELD = 0.010
"""The field that `link.field_ramp_ms` brings up, T."""

TOO_BUSY = 0.07
"""A computer that simulates nothing for this long, s, has stopped the simulated world rather than made the rig late:
with the camera's 35 ms and one frame, a longer gap would make a frame too old and a command expire."""

_names = (f"rig-{number}" for number in itertools.count(1))


@dataclass(slots=True)
class Machine:
    """A rig's parts, wired. world: None on a real rig."""

    settings: RigFile
    camera: Camera
    camera_model: CameraModel
    body_height: float
    tracker: ColourTracker
    coils: CoilSet
    link: Link
    loop: ControlLoop
    world: World | None

    def open(self) -> None:
        """Open the link; raises `LinkError`."""
        self.link.open()

    def stop_coils(self) -> None:
        """Zero now, from any thread; nothing is driven any more until a reset."""
        self.loop.estop()

    def close(self) -> None:
        """Zero the coils and give everything back."""
        self.link.close()
        self.camera.close()
        if self.world is not None:
            self.world.close()


def build_machine(settings: RigFile, *, realtime: bool) -> Machine:
    """Wire a rig. realtime: a simulated world keeps pace with the clock; else it runs as fast as it goes.

    Raises ValueError, `CameraError` and `LinkError` with what is wrong.
    """
    coils = _coils(settings)
    model = _camera_model(settings)
    world, port = _world(settings, coils, realtime) if settings.is_simulated else (None, settings.link.port)
    camera = _camera(settings, model, world, realtime)
    link = Link(port, settings.link.baud, _configuration(settings), camera.now)
    tracker = _tracker(settings, model)
    parts = _parts(settings, coils, link, tracker, simulated=world is not None)
    loop = ControlLoop(parts, time.perf_counter, camera.now())
    body_height = settings.robot.body_height_mm * MM
    return Machine(settings, camera, model, body_height, tracker, coils, link, loop, world)


def _parts(
    settings: RigFile, coils: CoilSet, link: Link, tracker: ColourTracker, *, simulated: bool
) -> Parts:
    field = FieldModel(settings.link.ramp_ms * MS, _field_slew(settings))
    length = settings.robot.length_mm * MM
    backlash = math.radians(settings.estimator.backlash_deg)
    return Parts(
        perception=Perception(tracker, field, _estimator(settings), length, backlash),
        actuation=Actuation(link, coils, field, _actuation(settings)),
        field=field,
        link=link,
        coils=coils,
        limits=_limits(settings),
        length=length,
        simulated=simulated,
        gait_model=_gait_model(settings),
        body_tilt=_body_tilt(settings.robot.lift_ratio),
    )


def _gait_model(settings: RigFile) -> GaitModel:
    gait = settings.gait
    return GaitModel(
        length=settings.robot.length_mm * MM,
        out=gait.out_mm * MM,
        forward_base=gait.forward_base_mm * MM,
        forward_per_sweep=gait.forward_per_sweep_mm_rad * MM,
        switch_time=settings.link.ramp_ms * MS,
        backlash=math.radians(settings.estimator.backlash_deg),
    )


def _coils(settings: RigFile) -> CoilSet:
    coils = settings.coils
    pairs = [_pair("x", coils.x), _pair("y", coils.y), _pair("z", coils.z)]
    return CoilSet(pairs, 0.5 * settings.limits.workspace_mm * MM)


def _pair(axis: str, coil: Coil) -> CoilPair:
    return CoilPair(
        axis,  # type: ignore[arg-type]
        diameter=coil.diameter_mm * MM,
        separation=coil.separation_mm * MM,
        turns=coil.turns,
        resistance=coil.resistance_ohm,
        inductance=coil.inductance_mH * 1e-3,
    )


def _camera_model(settings: RigFile) -> CameraModel:
    camera = settings.camera
    return CameraModel.looking_down(
        size=camera.size_px,
        height=camera.height_mm * MM,
        picture_height=camera.picture_height_mm * MM,
        tilt=(math.radians(camera.tilt_deg[0]), math.radians(camera.tilt_deg[1])),
        distortion=camera.distortion,
    )


def _world(settings: RigFile, coils: CoilSet, realtime: bool) -> tuple[World, str]:
    """The simulated world and the name of the port to its board."""
    simulation = settings.simulation
    start = Pose(
        simulation.start_x_mm * MM, simulation.start_y_mm * MM, math.radians(simulation.start_heading_deg)
    )
    plant = build_plant(simulation.plant, settings.robot.length_mm * MM, start, simulation.seed)
    board, port = _board(settings, realtime)
    return World(board, plant, coils), port


def _board(settings: RigFile, realtime: bool) -> tuple[Board, str]:
    if settings.simulation.board != "twin":
        return RemoteBoard(settings.simulation.board, realtime=realtime), settings.link.port
    name = next(_names)
    coils = settings.coils
    windings = _winding(coils.x), _winding(coils.y), _winding(coils.z)
    return TwinBoard(
        name, windings, coils.supply_V, boot_id=settings.simulation.seed % 0xFFFF + 1
    ), f"sim://{name}"


def _winding(coil: Coil) -> Winding:
    return Winding(coil.resistance_ohm, coil.inductance_mH * 1e-3)


def _camera(settings: RigFile, model: CameraModel, world: World | None, realtime: bool) -> Camera:
    if world is None:
        return open_camera(settings.camera.uri, settings.camera.size_px, settings.camera.rate_Hz)
    scene = SceneSettings(
        rate=settings.camera.rate_Hz,
        latency=settings.simulation.latency_ms * MS,
        noise=settings.simulation.noise,
        blur=settings.simulation.blur_px,
        seed=settings.simulation.seed,
        length=settings.robot.body_length_mm * MM,
        width=settings.robot.body_width_mm * MM,
        height=settings.robot.body_height_mm * MM,
    )
    return SyntheticCamera(world, model, scene, _pace(settings, realtime))


def _pace(settings: RigFile, realtime: bool) -> Pace:
    if not realtime:
        return AsFastAsItGoes()
    return RealTime(TOO_BUSY if settings.simulation.board == "twin" else None)


def _tracker(settings: RigFile, model: CameraModel) -> ColourTracker:
    vision, robot = settings.vision, settings.robot
    return ColourTracker(
        model,
        TrackerSettings(
            colour=ColourRange(vision.hue_deg, vision.saturation, vision.value),
            region=RegionFilter(vision.area_mm2[0] * 1e-6, vision.area_mm2[1] * 1e-6),
            heading_hint=math.radians(vision.heading_hint_deg),
        ),
        robot_length=robot.body_length_mm * MM,
        body_height=robot.body_height_mm * MM,
    )


def _field_slew(settings: RigFile) -> float:
    return FULL_FIELD / (settings.link.field_ramp_ms * MS)


def _configuration(settings: RigFile) -> Configuration:
    coils, limits = settings.coils, settings.limits
    x, y, z = coils.x, coils.y, coils.z
    return Configuration(
        current_limits=_triple(limits.current_A),
        dead_man=settings.link.dead_man_ms * MS,
        ramp=settings.link.ramp_ms * MS,
        field_slew=_field_slew(settings),
        resistances=(x.resistance_ohm, y.resistance_ohm, z.resistance_ohm),
        inductances=(x.inductance_mH * 1e-3, y.inductance_mH * 1e-3, z.inductance_mH * 1e-3),
        supply=coils.supply_V,
        max_field=limits.field_mT * 1e-3,
        max_rate=math.radians(limits.rate_deg_s),
        max_tilt=math.radians(60.0),
    )


def _estimator(settings: RigFile) -> EstimatorSettings:
    estimator = settings.estimator
    return EstimatorSettings(
        measured_position=estimator.measured_position_mm * MM,
        measured_heading=math.radians(estimator.measured_heading_deg),
        drift_position=estimator.drift_position_mm * MM,
        drift_heading=math.radians(estimator.drift_heading_deg),
        slip=estimator.slip_mm * MM,
        swing=estimator.swing_share,
        loose=estimator.loose_share,
        actuation_delay=estimator.actuation_delay_ms * MS,
        lift_ratio=settings.robot.lift_ratio,
        gait_model=_gait_model(settings),
    )


def _actuation(settings: RigFile) -> ActuationSettings:
    return ActuationSettings(
        currents=_triple(settings.limits.current_A),
        time_to_live=settings.link.time_to_live_ms * MS,
        tick=1.0 / settings.camera.rate_Hz,
        allocation=settings.coils.allocation,
    )


def _limits(settings: RigFile) -> Limits:
    limits = settings.limits
    half = 0.5 * limits.workspace_mm
    return Limits(
        currents=_triple(limits.current_A),
        field=limits.field_mT * 1e-3,
        rate=math.radians(limits.rate_deg_s),
        soft=(half + limits.soft_margin_mm) * MM,
        hard=(half + limits.hard_margin_mm) * MM,
    )


def _body_tilt(lift_ratio: float) -> Callable[[float], float]:
    return lambda tilt: body_tilt(tilt, lift_ratio)


def _triple(values: list[float]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z
