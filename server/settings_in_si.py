"""The rig file's values in SI, as the parts of a rig take them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from control.actuation import ActuationSettings
from control.coil_heat import ThermalLimits
from control.coils import CoilPair, CoilSet
from control.estimator import EstimatorSettings
from control.gait_model import GaitModel
from control.limiter import CoilLimits, check_field_slew
from control.link.conversion import Configuration
from control.model import body_tilt
from control.registration import Registration
from control.safety import Limits
from server.camera_sections import CameraSection
from server.coil_sections import Coil, RegistrationSection
from server.settings import MM, MS, RigFile
from vision.sources.request import CameraRequest

FULL_FIELD = 0.010
"""The field that `link.field_ramp_ms` brings up, T."""


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


def gait_model(settings: RigFile) -> GaitModel:
    gait = settings.gait
    return GaitModel(
        length=settings.robot.length_mm * MM,
        out=gait.out_mm * MM,
        forward_base=gait.forward_base_mm * MM,
        forward_per_sweep=gait.forward_per_sweep_mm_rad * MM,
        switch_time=settings.link.ramp_ms * MS,
        backlash=math.radians(settings.estimator.backlash_deg),
    )


def field_slew(settings: RigFile) -> float:
    return FULL_FIELD / (settings.link.field_ramp_ms * MS)


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


def board_configuration(settings: RigFile) -> Configuration:
    """What the board is told of this rig."""
    coils, limits = settings.coils, settings.limits
    x, y, z = coils.x, coils.y, coils.z
    return Configuration(
        current_limits=_triple(limits.current_A),
        dead_man=settings.link.dead_man_ms * MS,
        ramp=settings.link.ramp_ms * MS,
        field_slew=field_slew(settings),
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


def estimator_settings(settings: RigFile) -> EstimatorSettings:
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
        gait_model=gait_model(settings),
    )


def actuation_settings(settings: RigFile) -> ActuationSettings:
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
        field_slew=field_slew(settings),
    )


def thermal_limits(settings: RigFile) -> ThermalLimits:
    limits = settings.limits
    return ThermalLimits(_triple(limits.continuous_A), _triple(limits.heat_time_constant_s))


def check_slew(settings: RigFile, coils: CoilSet) -> None:
    """At the centre and in the corners, where a pair needs most and least current for its field."""
    for x, y in itertools.product((-coils.workspace, 0.0, coils.workspace), repeat=2):
        check_field_slew(coils.local_allocation(x, y), _coil_limits(settings))


def rig_limits(settings: RigFile) -> Limits:
    limits = settings.limits
    half = 0.5 * limits.workspace_mm
    return Limits(
        currents=_triple(limits.current_A),
        field=limits.field_mT * 1e-3,
        rate=math.radians(limits.rate_deg_s),
        soft=(half + limits.soft_margin_mm) * MM,
        hard=(half + limits.hard_margin_mm) * MM,
    )


def tilt_of_body(lift_ratio: float) -> Callable[[float], float]:
    return lambda tilt: body_tilt(tilt, lift_ratio)


def _triple(values: list[float]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z
