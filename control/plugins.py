"""Controllers and trajectories that others have written: from installed packages, or from one file.

A plug-in registers its classes with `@controllers.register` or `@trajectories.register`, as the built-in ones
do. One that cannot be loaded leaves nothing behind.
"""

from __future__ import annotations

import importlib.util
import itertools
import sys
import traceback
from collections.abc import Callable
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from control.controllers import controllers
from control.registry import Parameters, Registry
from control.trajectories import trajectories

GROUPS: dict[str, tuple[Registry[Any], str]] = {
    "pivotrig.controllers": (controllers, "step"),
    "pivotrig.trajectories": (trajectories, "point"),
}
"""Entry-point groups, the registry of each, and the method that its classes need."""

MODULES = "pivotrig_plugin_"
"""How the modules that are made of plug-in files begin."""
_numbers = itertools.count(1)


class PluginError(Exception):
    """A plug-in that cannot be used; the text says which, where and why."""


def load_file(path: Path) -> tuple[str, ...]:
    """Run a Python file that registers its classes; returns their names, raises `PluginError`."""
    if not path.is_file():
        raise PluginError(f"there is no plug-in file {path}; give the path of a .py file")
    name = f"{MODULES}{next(_numbers)}_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise PluginError(f"the plug-in {path} is not a Python file; its name must end in .py")
    loader, module = spec.loader, importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        return _guarded(str(path), lambda: loader.exec_module(module), str(path))
    except PluginError:
        del sys.modules[name]
        raise


def loaded_files() -> list[Path]:
    """The plug-in files in use, for a process that has to know the same names."""
    names = {entry.__module__: None for registry, _ in GROUPS.values() for entry in registry.values()}
    files = [sys.modules[name].__file__ for name in names if name.startswith(MODULES)]
    return [Path(file) for file in files if file is not None]


def load_installed() -> list[PluginError]:
    """Register what installed packages offer; returns what is wrong with those that were left out."""
    problems = []
    for group in GROUPS:
        for entry_point in entry_points(group=group):
            try:
                _load_entry_point(group, entry_point)
            except PluginError as error:
                problems.append(error)
    return problems


def _load_entry_point(group: str, entry_point: EntryPoint) -> None:
    registry, _ = GROUPS[group]

    def register() -> None:
        entry = entry_point.load()
        if entry not in registry.values():
            registry.register(entry)

    package = entry_point.dist.name if entry_point.dist is not None else "an unknown package"
    _guarded(f"{entry_point.name} ({entry_point.value}) of {package}", register)


def _guarded(title: str, load: Callable[[], object], file: str = "") -> tuple[str, ...]:
    """Load, check what was registered, and take all of it back when anything is wrong."""
    before = {group: set(registry) for group, (registry, _) in GROUPS.items()}
    try:
        load()
        added = _added(before)
        if file and not added:
            raise PluginError(
                f"the plug-in {title} registers nothing; put @controllers.register above its class"
            )
        for group, name in added:
            _check(title, group, name)
    except PluginError:
        _take_back(before)
        raise
    except (Exception, SystemExit) as error:  # the boundary to code that anyone may have written
        _take_back(before)
        raise PluginError(f"the plug-in {title} cannot be loaded: {_where(error, file)}") from error
    return tuple(name for _, name in added)


def _added(before: dict[str, set[str]]) -> list[tuple[str, str]]:
    return [
        (group, name)
        for group, (registry, _) in GROUPS.items()
        for name in registry
        if name not in before[group]
    ]


def _take_back(before: dict[str, set[str]]) -> None:
    for group, name in _added(before):
        GROUPS[group][0].forget(name)


def _check(title: str, group: str, name: str) -> None:
    """A registered class has all that lists, forms and runs need of it."""
    registry, method = GROUPS[group]
    entry = registry[name]
    texts = {text: getattr(entry, text, None) for text in ("name", "title", "summary")}
    missing = [text for text, value in texts.items() if not (isinstance(value, str) and value)]
    if not callable(getattr(entry, method, None)):
        missing.append(f"{method}()")
    parameters = getattr(entry, "Parameters", None)
    if not (isinstance(parameters, type) and issubclass(parameters, Parameters)):
        missing.append("Parameters, a subclass of control.registry.Parameters")
    if missing:
        raise PluginError(
            f"the {registry.kind} {entry.__name__} of plug-in {title} lacks: {', '.join(missing)}"
        )


def _where(error: BaseException, file: str) -> str:
    """`file, line 7: NameError: …`, with the plug-in's own line where the error passed through it."""
    what = f"{type(error).__name__}: {error}"
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}, line {error.lineno}: {error.msg}"
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if frame.filename == file] or frames
    return f"{own[-1].filename}, line {own[-1].lineno}: {what}"
