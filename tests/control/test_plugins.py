"""Third-party controllers and trajectories: found, checked, and harmless when they are broken."""

import importlib.metadata
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from control import plugins
from control.controllers import controllers
from control.plugins import PluginError
from control.trajectories import trajectories

EXAMPLE = Path(__file__).parents[1] / "examples" / "spiral_chaser.py"

GOOD = """
from control.controllers import Decision, controllers
from control.registry import Parameters

@controllers.register
class Still:
    name, title, summary, Parameters = "still", "Still", "Stands still.", Parameters
    def __init__(self, parameters): pass
    def step(self, situation): return Decision(situation.pivot, 0.0)
"""


@pytest.fixture(autouse=True)
def registries_are_left_as_they_were() -> Iterator[None]:
    before = [(registry, set(registry)) for registry in (controllers, trajectories)]
    yield
    for registry, names in before:
        for name in set(registry) - names:
            registry.forget(name)


def file_with(folder: Path, text: str) -> Path:
    path = folder / "mine.py"
    path.write_text(text)
    return path


def test_the_example_of_the_manual_is_thirty_lines_and_loads() -> None:
    assert len(EXAMPLE.read_text().splitlines()) <= 30
    assert plugins.load_file(EXAMPLE) == ("spiral_chaser",)
    assert controllers.build("spiral_chaser", {"lead_s": 0.5}).name == "spiral_chaser"


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("def broken(:\n", "mine.py, line 1: "),
        ("\n\nimport nowhere_to_be_found\n", "mine.py, line 3: ModuleNotFoundError"),
        (GOOD + "\nraise RuntimeError('too late')\n", "line 11: RuntimeError: too late"),
        (GOOD + "\nraise SystemExit(5)\n", "line 11: SystemExit: 5"),
        (
            GOOD.replace('"still"', '"geometric"'),
            "line 5: ValueError: a controller called 'geometric' is registered",
        ),
        (GOOD.replace("def step", "def walk"), "lacks: step()"),
        (GOOD.replace('"Stands still."', "None"), "lacks: summary"),
        (GOOD.replace(", Parameters =", ", Settings ="), "lacks: Parameters"),
        (GOOD.replace('"still"', "7"), "needs a name"),
        ("x = 1\n", "registers nothing"),
    ],
)
def test_a_broken_plugin_is_explained_and_leaves_nothing_behind(
    tmp_path: Path, text: str, complaint: str
) -> None:
    before = list(controllers)
    with pytest.raises(PluginError) as problem:
        plugins.load_file(file_with(tmp_path, text))
    assert complaint in str(problem.value)
    assert "mine.py" in str(problem.value)
    assert list(controllers) == before


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(PluginError, match=r"no plug-in file .*none\.py"):
        plugins.load_file(tmp_path / "none.py")


def test_a_file_that_is_not_python_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "plugin.txt"
    path.write_text(GOOD)
    with pytest.raises(PluginError, match=r"must end in \.py"):
        plugins.load_file(path)


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An installed package with a good and a broken entry point."""
    (tmp_path / "third_party.py").write_text(GOOD.replace("@controllers.register", ""))
    (tmp_path / "third_party_broken.py").write_text("raise RuntimeError('not today')\n")
    folder = tmp_path / "third_party-1.0.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: third-party\nVersion: 1.0\n")
    (folder / "entry_points.txt").write_text(
        "[pivotrig.controllers]\nstill = third_party:Still\nbroken = third_party_broken:Broken\n"
        "[pivotrig.trajectories]\nmissing = third_party:Spiral\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    return tmp_path


def test_installed_plugins_are_registered_and_broken_ones_left_out(package: Path) -> None:
    problems = [str(problem) for problem in plugins.load_installed()]
    assert "still" in controllers
    assert len(problems) == 2
    assert "broken (third_party_broken:Broken) of third-party" in problems[0]
    assert f"{package}/third_party_broken.py, line 1: RuntimeError: not today" in problems[0]
    assert "missing (third_party:Spiral)" in problems[1]
    assert plugins.load_installed(), "a second look finds the same problems and registers nothing twice"
    for module in ("third_party", "third_party_broken"):
        sys.modules.pop(module, None)
