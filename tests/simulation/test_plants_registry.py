"""The simulated robots by name, with their parameters."""

import math
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from typer.testing import CliRunner

from control.model import Pose
from control.registry import UnknownName
from control.simulation.plants import (
    MissingExtra,
    PlantChoice,
    SlipChoiceParameters,
    SlipKind,
    build_plant,
    plants,
)
from control.simulation.rigid.parameters import GRAVITY, RigidParameters
from control.simulation.slip import NO_SLIP, SLIP_TABLE
from control.studies.definition import StudyDefinition
from control.studies.workers import WorkersLost, carry_out
from server.cli import app
from server.settings import RigFile

START = Pose(0.01, -0.02, 0.3)


@pytest.fixture
def without_mujoco(monkeypatch: pytest.MonkeyPatch) -> None:
    """As on a computer where it was never installed."""
    for module in [name for name in sys.modules if name.startswith("control.simulation.rigid.")]:
        if module.rpartition(".")[2] in ("engine", "plant"):
            monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "mujoco", None)


@pytest.mark.parametrize("name", ["slip", "noslip", "rigid"])
def test_every_plant_begins_where_it_is_put(name: str) -> None:
    plant = build_plant(PlantChoice(name), 0.01, START, seed=3)
    assert plant.pose == START
    assert plant.position == (START.x, START.y)
    assert plant.counters.switches == 0
    assert plants[name].title
    assert plants[name].summary


@pytest.mark.parametrize("name", ["slip", "noslip", "rigid"])
def test_every_parameter_says_what_it_is(name: str) -> None:
    for parameter in plants[name].Parameters.model_fields.values():
        assert parameter.title
        assert parameter.description


def test_the_kinematic_plants_take_their_tables_as_they_are() -> None:
    slip, noslip = build_plant(PlantChoice(), 0.01, START), build_plant(PlantChoice("noslip"), 0.01, START)
    assert slip.parameters is SLIP_TABLE  # type: ignore[attr-defined]
    assert noslip.parameters is NO_SLIP  # type: ignore[attr-defined]


@given(st.floats(0.0, 10.0), st.floats(0.0, 10.0), st.floats(0.0, 10.0))
def test_a_scaled_table_keeps_its_tilts_and_scales_means_and_scatter_apart(slip, scatter, play):
    kind = plants.build("slip", {"slip_scale": slip, "scatter_scale": scatter, "play_scale": play})
    assert isinstance(kind, SlipKind)
    for row, scaled in zip(SLIP_TABLE.rows, kind.table.rows, strict=True):
        assert scaled.tilt == row.tilt
        assert (scaled.out, scaled.forward_base) == (slip * row.out, slip * row.forward_base)
        assert (scaled.out_sd, scaled.play_sd) == (scatter * row.out_sd, scatter * row.play_sd)
        assert scaled.play == play * row.play


@pytest.mark.parametrize(
    ("choice", "complaint"),
    [
        (PlantChoice("slip", {"slip_scale": -1.0}), "slip_scale"),
        (PlantChoice("slip", {"friction": 0.4}), "friction"),
        (PlantChoice("noslip", {"slip_scale": 1.0}), "slip_scale"),
        (PlantChoice("rigid", {"moment_mA_m2": math.nan}), "moment_mA_m2"),
    ],
)
def test_a_parameter_that_a_plant_does_not_have_or_allow_is_refused(choice, complaint):
    with pytest.raises(ValidationError, match=complaint):
        build_plant(choice, 0.01, START)


def test_an_unknown_plant_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UnknownName, match="'soap'; choose one of: slip, noslip, rigid"):
        build_plant(PlantChoice("soap"), 0.01, START)


def test_the_rig_file_gives_its_plant_that_plants_parameters() -> None:
    settings = (
        RigFile().with_simulation(plant="rigid", rigid={"friction": 0.7}, slip={"play_scale": 0.5}).simulation
    )
    assert settings.plant_choice == PlantChoice("rigid", RigidParameters(friction=0.7).model_dump())
    slip = RigFile().with_simulation(slip={"play_scale": 0.5}).simulation.plant_choice
    assert slip == PlantChoice("slip", SlipChoiceParameters(play_scale=0.5).model_dump())
    assert RigFile().with_simulation(plant="noslip").simulation.plant_choice == PlantChoice("noslip", {})


def test_lambda_is_the_magnets_torque_over_what_lifts_one_end() -> None:
    plausible, bare = RigidParameters(), RigidParameters(adhesion_mN=0.0)
    assert plausible.magnetic_ratio(0.01) == pytest.approx(2.62, abs=0.01)
    assert bare.magnetic_ratio(0.01) == pytest.approx(2 * 1.8e-3 * 10e-3 / (79e-6 * GRAVITY * 0.01))
    assert math.sin(plausible.lifting_elevation(0.01)) * plausible.magnetic_ratio(0.01) == pytest.approx(1.0)
    assert math.isinf(RigidParameters(moment_mA_m2=0.1).lifting_elevation(0.01))


@pytest.mark.usefixtures("without_mujoco")
def test_without_mujoco_the_rigid_plant_says_which_extra_to_install() -> None:
    with pytest.raises(MissingExtra, match="extra `physics` with `uv sync --extra physics`"):
        build_plant(PlantChoice("rigid"), 0.01, START)
    assert build_plant(PlantChoice("slip"), 0.01, START).pose == START


@pytest.mark.usefixtures("without_mujoco")
def test_a_run_with_the_rigid_plant_ends_with_the_same_words(tmp_path) -> None:
    arguments = ["run", "--plant", "rigid", "--json", "--no-record", "--data", str(tmp_path)]
    answer = CliRunner().invoke(app, arguments)
    assert answer.exit_code == 2
    assert "extra `physics`" in answer.stderr
    assert answer.stdout == ""


@pytest.mark.usefixtures("without_mujoco")
def test_a_study_that_goes_on_without_mujoco_makes_no_failed_runs_of_it() -> None:
    """A failed run is a result and is never done again; what is not installed can be installed."""
    definition = StudyDefinition.from_json(
        {
            "name": "Without",
            "trajectory": {"name": "circle"},
            "plant": {"name": "rigid"},
            "axes": [{"of": "gait.tilt_deg", "values": [25]}],
        }
    )
    with pytest.raises(WorkersLost, match="extra `physics`"):
        list(carry_out([definition.plan().run(0, {})], jobs=1))
