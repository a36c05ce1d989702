"""From a rig file to a working rig: the one place that knows which parts are simulated."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from control.actuation import Actuation, ActuationSettings
from control.coil_heat import ThermalLimits
from control.coils import CoilPair, CoilSet
from control.estimator import EstimatorSettings
from control.field_model import FieldModel
from control.gait_model import GaitModel
from control.limiter import CoilLimits, check_field_slew
from control.link.conversion import Configuration
from control.link.port import Link
from control.link.traffic import TrafficLog
from control.loop import ControlLoop
from control.model import Pose, body_tilt
from control.parts import Camera, Parts
from control.perception import Perception, Tracker
from control.registration import Registration
from control.safety import Limits
from control.simulation.board import TwinBoard, Winding
from control.simulation.emulated import EmulatedBoard, prepare
from control.simulation.faults.injection import Faults
from control.simulation.lockstep import RemoteBoard
from control.simulation.plant import build_plant
from control.simulation.wiring import Wiring
from control.simulation.world import Board, World
from server.data_folder import data_folder
from server.optics import assumed_model, calibration_problem, model_in_use
from server.seams import FaultySeams, Seams
from server.settings import MM, MS, CameraSection, Coil, RegistrationSection, RigFile
from server.vision_settings import tracker_settings
from vision.camera_model import CameraModel
from vision.simulated.camera import AsFastAsItGoes, Pace, RealTime, SceneSettings, SyntheticCamera
from vision.simulated.scenes import SCENES
from vision.sources.opening import CameraRequest, open_camera
from vision.tracking.tracker import ColourTracker

FULL_FIELD = 0.010
"""The field that `link.field_ramp_ms` brings up, T."""

TOO_BUSY = 0.07
"""A computer that simulates nothing for this long, s, has stopped the simulated world rather than made the rig late:
with the camera's 35 ms and one frame, a longer gap would make a frame too old and a command expire."""

TRAFFIC_LOG = "link-traffic.log"
"""In the data folder."""

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
    faults: Faults | None
    traffic: TrafficLog | None

    def open(self, *, patiently: bool = False, camera_may_come: bool = False) -> None:
        """Wait for the camera and open the link; raises `CameraError` and `LinkError`.

        patiently: a board that is not there is waited for in the background.  camera_may_come: so is a camera.
        """
        if not camera_may_come:
            self.camera.require()
        self.link.open(patiently=patiently)

    def stop_coils(self) -> None:
        """Zero now, from any thread; nothing is driven any more until a reset."""
        self.loop.estop()

    def close(self) -> None:
        """Zero the coils and give everything back."""
        self.link.close()
        if self.traffic is not None:
            self.traffic.close()
        self.camera.close()
        if self.world is not None:
            self.world.close()


def build_machine(settings: RigFile, *, realtime: bool, data: Path | None = None) -> Machine:
    """Wire a rig. realtime: a simulated world keeps pace with the clock; else it runs as fast as it goes.
    data: the data folder, if not the user's.

    Raises ValueError, `CameraError` and `LinkError` with what is wrong.
    """
    coils = coil_set(settings)
    _check_field_slew(settings, coils)
    model = model_in_use(settings.camera)
    tracker = _tracker(settings, model)
    with ExitStack() as devices:
        world, port = (
            _world(settings, coils, realtime) if settings.is_simulated else (None, settings.link.port)
        )
        if world is not None:
            devices.callback(world.close)
        camera = _camera(settings, world, realtime)
        devices.callback(camera.close)
        seams = _seams(settings, world, camera)
        link = seams.link(port, settings.link.baud, board_configuration(settings), camera.now)
        traffic = _traffic(settings, link, camera, data)
        parts = _parts(settings, coils, link, seams.tracker(tracker), seams, camera)
        loop = ControlLoop(parts, time.perf_counter, camera.now())
        faults = seams.faults(camera.now, loop)
        devices.pop_all()  # the machine closes them from now on
    body_height = settings.robot.body_height_mm * MM
    return Machine(settings, camera, model, body_height, tracker, coils, link, loop, world, faults, traffic)


def _traffic(settings: RigFile, link: Link, camera: Camera, data: Path | None) -> TrafficLog | None:
    if not settings.link.traffic_log:
        return None
    traffic = TrafficLog(data_folder(data) / TRAFFIC_LOG, camera.now)
    link.put_before(traffic.wrap)
    return traffic


def _seams(settings: RigFile, world: World | None, camera: Camera) -> Seams:
    if world is None or not isinstance(camera, SyntheticCamera):
        return Seams()
    return FaultySeams(settings, world, camera)


def _parts(
    settings: RigFile, coils: CoilSet, link: Link, tracker: Tracker, seams: Seams, camera: Camera
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
        thermal=_thermal(settings),
        frame_size=settings.camera.size_px,
        length=length,
        simulated=camera.simulated,
        gait_model=_gait_model(settings),
        body_tilt=_body_tilt(settings.robot.lift_ratio),
        controller_case=seams.controller,
        camera_trouble=lambda: camera.trouble,
        calibration_problem=lambda: calibration_problem(settings.camera, camera.identity),
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


def coil_set(settings: RigFile) -> CoilSet:
    """The rig's coils; raises ValueError when they cannot make every direction of field."""
    coils = settings.coils
    pairs = [_pair("x", coils.x), _pair("y", coils.y), _pair("z", coils.z)]
    return CoilSet(pairs, 0.5 * settings.limits.workspace_mm * MM, registration_of(coils.registration))


def registration_of(section: RegistrationSection) -> Registration:
    """The same in SI."""
    return Registration(
        x=section.x_mm * MM,
        y=section.y_mm * MM,
        rotation=math.radians(section.rotation_deg),
        magnet_reversed=section.magnet_reversed,
    )


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


def _pair(axis: str, coil: Coil) -> CoilPair:
    return CoilPair(
        axis,  # type: ignore[arg-type]
        diameter=coil.diameter_mm * MM,
        separation=coil.separation_mm * MM,
        turns=coil.turns,
        resistance=coil.resistance_ohm,
        inductance=coil.inductance_mH * 1e-3,
        gain=coil.field_gain,
    )


def _world(settings: RigFile, coils: CoilSet, realtime: bool) -> tuple[World, str]:
    """The simulated world and the name of the port to its board."""
    simulation = settings.simulation
    start = Pose(
        simulation.start_x_mm * MM, simulation.start_y_mm * MM, math.radians(simulation.start_heading_deg)
    )
    plant = build_plant(simulation.plant, settings.robot.length_mm * MM, start, simulation.seed)
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


def _camera(settings: RigFile, world: World | None, realtime: bool) -> Camera:
    if world is None:
        return open_camera(settings.camera.uri, camera_request(settings.camera))
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


def camera_request(section: CameraSection) -> CameraRequest:
    """What a real camera is asked to do."""
    exposure = section.exposure_ms
    return CameraRequest(
        size=section.size_px,
        rate=section.rate_Hz,
        exposure=None if exposure is None else exposure * MS,
        gain=section.gain,
        white_balance=section.white_balance_K,
        latency=section.latency_ms * MS,
    )


def _pace(settings: RigFile, realtime: bool) -> Pace:
    if not realtime:
        return AsFastAsItGoes()
    return RealTime(TOO_BUSY if settings.simulation.board == "twin" else None)


def _tracker(settings: RigFile, model: CameraModel) -> ColourTracker:
    robot = settings.robot
    return ColourTracker(
        model,
        tracker_settings(settings.vision),
        robot_length=robot.body_length_mm * MM,
        body_height=robot.body_height_mm * MM,
    )


def _field_slew(settings: RigFile) -> float:
    return FULL_FIELD / (settings.link.field_ramp_ms * MS)


def board_configuration(settings: RigFile) -> Configuration:
    """What the board is told of this rig."""
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
        sense_gains=(_sense_gains(x), _sense_gains(y), _sense_gains(z)),
        supply_scale=coils.supply_full_scale_V,
    )


def _sense_gains(coil: Coil) -> tuple[float, float]:
    forward, reverse = coil.sense_mA_per_count
    return forward * 1e-3, reverse * 1e-3


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
        limits=_coil_limits(settings),
        time_to_live=settings.link.time_to_live_ms * MS,
        tick=1.0 / settings.camera.rate_Hz,
        allocation=settings.coils.allocation,
    )


def _coil_limits(settings: RigFile) -> CoilLimits:
    coils, limits = settings.coils, settings.limits
    return CoilLimits(
        currents=_triple(limits.current_A),
        power=limits.power_W,
        slew=_triple(limits.current_slew_A_s),
        resistances=(coils.x.resistance_ohm, coils.y.resistance_ohm, coils.z.resistance_ohm),
        ramp=settings.link.ramp_ms * MS,
        field_slew=_field_slew(settings),
    )


def _thermal(settings: RigFile) -> ThermalLimits:
    limits = settings.limits
    return ThermalLimits(_triple(limits.continuous_A), _triple(limits.heat_time_constant_s))


def _check_field_slew(settings: RigFile, coils: CoilSet) -> None:
    """At the centre and in the corners, where a pair needs most and least current for its field."""
    for x, y in itertools.product((-coils.workspace, 0.0, coils.workspace), repeat=2):
        check_field_slew(coils.local_allocation(x, y), _coil_limits(settings))


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
