"""From a rig file to a working rig: the one place that knows which parts are simulated."""

from __future__ import annotations

import math
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from control.actuation import Actuation
from control.coils import CoilSet
from control.field_model import FieldModel
from control.link.port import Link
from control.link.traffic import TrafficLog
from control.loop import ControlLoop
from control.parts import Camera, Parts
from control.perception import Perception, Tracker
from control.simulation.faults.injection import Faults
from control.simulation.world import World
from server.calibration.optics import calibration_problem, model_in_use
from server.data_folder import data_folder
from server.garbage import set_aside
from server.recording.writing.disk import Disk
from server.seams import FaultySeams, Seams
from server.settings import MM, MS, RigFile
from server.settings_in_si import (
    actuation_settings,
    board_configuration,
    camera_request,
    check_slew,
    coil_set,
    estimator_settings,
    field_slew,
    gait_model,
    rig_limits,
    thermal_limits,
    tilt_of_body,
)
from server.simulated_rig import simulated_camera, simulated_world
from server.vision_settings import tracker_settings
from vision.camera_model import CameraModel
from vision.simulated.camera import SyntheticCamera
from vision.sources.opening import open_camera
from vision.tracking.tracker import ColourTracker

TRAFFIC_LOG = "link-traffic.log"
"""In the data folder."""


@dataclass(slots=True)
class Machine:
    """A rig's parts, wired. world: None on a real rig.  disk: where recordings go."""

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
    disk: Disk

    def open(self, *, patiently: bool = False, camera_may_come: bool = False) -> None:
        """Wait for the camera and open the link; raises `CameraError` and `LinkError`.

        patiently: a board that is not there is waited for in the background.  camera_may_come: so is a camera.
        """
        if not camera_may_come:
            self.camera.require()
        if self.world is None:
            set_aside()  # no current flows yet; later a search for garbage would hold up the loop that drives
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
    check_slew(settings, coils)
    model = model_in_use(settings.camera)
    tracker = _tracker(settings, model)
    with ExitStack() as devices:
        world, port = (
            simulated_world(settings, coils, realtime)
            if settings.is_simulated
            else (None, settings.link.port)
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
    disk = seams.disk()
    return Machine(
        settings, camera, model, body_height, tracker, coils, link, loop, world, faults, traffic, disk
    )


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
    field = FieldModel(settings.link.ramp_ms * MS, field_slew(settings))
    length = settings.robot.length_mm * MM
    backlash = math.radians(settings.estimator.backlash_deg)
    return Parts(
        perception=Perception(tracker, field, estimator_settings(settings), length, backlash),
        actuation=Actuation(link, coils, field, actuation_settings(settings)),
        field=field,
        link=link,
        coils=coils,
        limits=rig_limits(settings),
        thermal=thermal_limits(settings),
        frame_size=settings.camera.size_px,
        length=length,
        simulated=camera.simulated,
        gait_model=gait_model(settings),
        body_tilt=tilt_of_body(settings.robot.lift_ratio),
        controller_case=seams.controller,
        camera_trouble=lambda: camera.trouble,
        calibration_problem=lambda: calibration_problem(settings.camera, camera.identity),
    )


def _camera(settings: RigFile, world: World | None, realtime: bool) -> Camera:
    if world is not None:
        return simulated_camera(settings, world, realtime)
    return open_camera(settings.camera.uri, camera_request(settings.camera))


def _tracker(settings: RigFile, model: CameraModel) -> ColourTracker:
    robot = settings.robot
    return ColourTracker(
        model,
        tracker_settings(settings.vision),
        robot_length=robot.body_length_mm * MM,
        body_height=robot.body_height_mm * MM,
    )
