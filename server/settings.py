"""The rig file: one lab's rig in one TOML file, lab units in the names, validated whole.

The defaults are the paper's rig, simulated (paper, section 6; what is assumed there is assumed here).
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from control.simulation.plants import PlantChoice, SlipChoiceParameters
from control.simulation.rigid.parameters import RigidParameters
from control.simulation.wiring import Wiring
from server.camera_sections import LIVE, SIMULATED_CAMERA, CameraSection
from server.coil_sections import Coils, LimitsSection, PerCoil, RegistrationSection
from server.notification_section import NotificationsSection, shown_webhook
from server.recording_section import RecordingSection
from server.section import NOT_MEASURED, Section
from server.vision_section import VisionSection
from vision.simulated.scene_names import FOR_ANY_LENS
from vision.sources.addresses import shown

MM = 1e-3
MS = 1e-3

FORMAT = 1
"""Version of the rig file's layout that this program reads and writes."""

Sigma = Annotated[float, Field(gt=0.0, le=1000.0)]

Lead = Literal["x", "y", "z", "-x", "-y", "-z"]


class Robot(Section):
    """length: between the two pivots; the body is what the camera sees."""

    length_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 10.0
    body_length_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 10.0
    body_width_mm: Annotated[float, Field(gt=0.0, le=100.0)] = 4.0
    body_height_mm: Annotated[float, Field(ge=0.0, le=50.0)] = 3.0
    lift_ratio: Annotated[float, Field(gt=0.0, le=1000.0)] = 3.2
    """2 m B / (W L): magnet torque over weight; decides how far the free end lifts."""


class LinkSection(Section):
    port: str = "sim://"
    """A device, best by its lasting name under /dev/serial/by-id; "auto" is the one board that is plugged in."""
    baud: Annotated[int, Field(ge=9600, le=2_000_000)] = 500_000
    dead_man_ms: Annotated[int, Field(ge=20, le=500)] = 200
    time_to_live_ms: Annotated[int, Field(ge=20, le=500)] = 150
    """Of one drive command: nine frames at 60 Hz."""
    ramp_ms: Annotated[int, Field(ge=1, le=1000)] = 50
    """Elevation ramp at a pivot switch; the heading is held meanwhile."""
    field_ramp_ms: Annotated[int, Field(ge=1, le=10_000)] = 300
    """From zero to 10 mT at arming."""
    traffic_log: bool = False
    """Every byte both ways goes to link-traffic.log in the data folder: at most 80 MiB."""


class EstimatorSection(Section):
    """Standard deviations of the filter's model and of one sighting."""

    measured_position_mm: Sigma = 0.04
    measured_heading_deg: Sigma = 0.35
    drift_position_mm: Sigma = 0.2
    """Per root second at rest."""
    drift_heading_deg: Sigma = 2.0
    slip_mm: Sigma = 0.5
    """Per pivot switch."""
    swing_share: Annotated[float, Field(gt=0.0, le=1.0)] = 0.12
    """Of the angle that the field turns, once it pulls the body along."""
    loose_share: Annotated[float, Field(gt=0.0, le=2.0)] = 0.6
    """The same while the field may still be taking up the play after a reversal."""
    actuation_delay_ms: Annotated[float, Field(ge=0.0, le=200.0)] = 1.0
    backlash_deg: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    """First guess of the play between field and body; it is identified while walking."""


Slip = Annotated[float, Field(ge=-10.0, le=10.0)]


class GaitSection(Section):
    """What a pivot switch does to this robot, from `pivotrig calibrate gait`; zero until that has been done."""

    out_mm: Slip = 0.0
    """The new pivot lands this far out of its place, along the body."""
    forward_base_mm: Slip = 0.0
    """It lands this far ahead in the direction of walking,"""
    forward_per_sweep_mm_rad: Slip = 0.0
    """and this much further for each radian of the sweep."""
    source: Annotated[str, Field(max_length=160)] = NOT_MEASURED
    """Where these figures, the robot's length and its play come from: date and standard errors."""


class SimulationSection(Section):
    """The simulated rig; only read where the camera or the port is simulated."""

    plant: Literal["slip", "noslip", "rigid"] = "slip"
    slip: SlipChoiceParameters = SlipChoiceParameters()
    """Of the plant slip; the others' parameters wait until they are chosen."""
    rigid: RigidParameters = RigidParameters()
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 1
    board: str = Field(default="twin", pattern=r"^(twin|emulated|tcp://\S+)$")
    """twin: the board's twin in this process; emulated: the compiled firmware in an emulator, which is built and
    started; tcp://HOST:PORT: another board behind its lock-step port."""
    latency_ms: Annotated[float, Field(ge=0.0, le=120.0)] = 35.0
    """The rig holds when frames get older than 150 ms."""
    stamps: Literal["capture", "arrival"] = "capture"
    """capture: frames bear the true time of their exposure; arrival: that at which they come, less
    camera.latency_ms, as a real camera's do."""
    scene: str = "clean"
    """What is in front of the camera beside the robot, and in which light; the lens stays that of [camera]."""
    noise: Annotated[float, Field(ge=0.0, le=50.0)] = 3.0
    """Grey levels."""
    blur_px: Annotated[float, Field(ge=0.0, le=10.0)] = 0.7
    start_x_mm: Annotated[float, Field(ge=-60.0, le=60.0)] = 0.0
    start_y_mm: Annotated[float, Field(ge=-60.0, le=60.0)] = -42.0
    start_heading_deg: Annotated[float, Field(ge=-360.0, le=360.0)] = 90.0
    wiring: tuple[Lead, Lead, Lead] = ("x", "y", "z")
    """The pairs that the three bridges truly drive; -x: with swapped leads."""
    field_gain: PerCoil | None = None
    """The true gains of the fields x, y, z; without it those that the rig file gives the coils."""
    registration: RegistrationSection | None = None
    """Where the coils truly stand; without it where the rig file says."""

    @property
    def plant_choice(self) -> PlantChoice:
        """The simulated robot with the parameters of its own section."""
        sections = {"slip": self.slip, "rigid": self.rigid}
        return PlantChoice(self.plant, sections[self.plant].model_dump() if self.plant in sections else {})

    @field_validator("scene")
    @classmethod
    def _scene_is_known(cls, scene: str) -> str:
        if scene not in FOR_ANY_LENS:
            raise ValueError(f"there is no scene called {scene!r}; choose one of: {', '.join(FOR_ANY_LENS)}")
        return scene

    @model_validator(mode="after")
    def _each_pair_has_one_bridge(self) -> SimulationSection:
        Wiring(self.wiring)
        return self


REAL_PORTS = ("/dev/ttyACM", "/dev/ttyUSB", "/dev/serial/", "/dev/cu.", "auto")
"""Names that a real board's port begins with."""


class RigFile(Section):
    """One rig."""

    version: Literal[1] = FORMAT
    """Of the file's layout; a file without it has the first."""
    name: Annotated[str, Field(min_length=1, max_length=80)] = "The paper's rig"
    robot: Robot = Robot()
    coils: Coils = Coils()
    limits: LimitsSection = LimitsSection()
    camera: CameraSection = CameraSection()
    link: LinkSection = LinkSection()
    vision: VisionSection = VisionSection()
    estimator: EstimatorSection = EstimatorSection()
    gait: GaitSection = GaitSection()
    recording: RecordingSection = RecordingSection()
    notifications: NotificationsSection = NotificationsSection()
    simulation: SimulationSection = SimulationSection()

    @property
    def is_simulated(self) -> bool:
        return self.camera.uri.startswith("sim://")

    @property
    def latency_is_known(self) -> bool:
        """Whether the frames' stamps can be believed: what they are late by is known, or they are not late."""
        camera = self.camera
        if camera.latency_source != NOT_MEASURED or camera.latency_ms > 0.0:
            return True
        if self.is_simulated:
            return self.simulation.stamps == "capture"
        return camera.uri.partition(":")[0].lower() not in LIVE

    @property
    def subtracted_latency_ms(self) -> float:
        """What the frames' stamps have been corrected by; nothing where a simulated camera knows the true time."""
        knows_better = self.is_simulated and self.simulation.stamps == "capture"
        return 0.0 if knows_better else self.camera.latency_ms

    @model_validator(mode="after")
    def _camera_and_port_share_a_world(self) -> RigFile:
        if self.link.port.startswith("sim://") and not self.is_simulated:
            raise ValueError(
                'a simulated port (link.port) needs the simulated camera (camera.uri = "sim://")'
            )
        if (
            self.is_simulated
            and self.simulation.board.startswith("tcp://")
            and self.link.port.startswith(REAL_PORTS)
        ):
            raise ValueError(
                f"link.port is {self.link.port!r}, a real board's, and camera.uri is simulated: coils would carry "
                "current for a robot that nobody sees. Give the port that the board process has printed"
            )
        return self

    def to_public(self) -> dict[str, Any]:
        """The values as the outside sees them: without the login of a network camera and a webhook's key."""
        values = {**self.model_dump(mode="json"), "simulated": self.is_simulated}
        values["camera"]["uri"] = shown(self.camera.uri)
        values["notifications"]["webhook_url"] = shown_webhook(self.notifications.webhook_url)
        return values

    def to_recorded(self) -> dict[str, Any]:
        """The values that a run was made with; who is told of its end is none of them."""
        values = self.to_public()
        del values["notifications"]
        return values

    def with_simulation(self, **changes: Any) -> RigFile:
        """The same rig with other values in its simulation section, validated."""
        whole = self.model_dump(mode="json")
        whole["simulation"] = {**whole["simulation"], **changes}
        return RigFile.model_validate(whole)

    def as_simulated(self) -> RigFile:
        """The same rig with its camera and port simulated."""
        whole = self.model_dump(mode="json")
        whole["camera"]["uri"] = whole["link"]["port"] = "sim://"
        for part in ("lens", "plane"):
            if whole["camera"][part] and whole["camera"][part]["identity"] != SIMULATED_CAMERA:
                whole["camera"][part] = None
        whole["simulation"]["board"] = "twin"
        return RigFile.model_validate(whole)
