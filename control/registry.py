"""Controllers and trajectories by name: each is a class with a title, a summary and a pydantic parameter model.

The parameter models are what the outside sees, so their fields are in the lab's units and carry them in
their names or in the schema's `unit`; the classes convert to SI when they are built.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Generic, Protocol, TypeVar

from pydantic import BaseModel, ConfigDict


class Parameters(BaseModel):
    """Base of all parameter models: unknown fields, NaN and infinity are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class UnknownName(LookupError):
    """A controller or trajectory that nobody registered."""

    def __init__(self, kind: str, name: str, known: list[str]) -> None:
        super().__init__(f"there is no {kind} called {name!r}; choose one of: {', '.join(known)}")


class Entry(Protocol):
    """What a registered class shows of itself."""

    name: str
    title: str
    summary: str
    Parameters: type[Parameters]

    def __init__(self, parameters: Any) -> None: ...


E = TypeVar("E", bound=Entry)
T = TypeVar("T")


class Registry(Mapping[str, type[E]], Generic[E]):
    """Registered classes of one kind, in the order of their registration."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        self._entries: dict[str, type[E]] = {}

    def register(self, entry: type[T]) -> type[T]:
        """Class decorator: make the class known under its `name`, which must be free."""
        kind: Any = entry
        if not (isinstance(getattr(entry, "name", None), str) and kind.name):
            raise ValueError(f"the {self.kind} {entry.__name__} needs a name: a class attribute, a text")
        if kind.name in self._entries:
            raise ValueError(f"a {self.kind} called {kind.name!r} is registered already")
        self._entries[kind.name] = kind
        return entry

    def forget(self, name: str) -> None:
        """Take a class out again."""
        del self._entries[name]

    def build(self, name: str, parameters: Mapping[str, Any]) -> E:
        """An instance from raw parameters; raises `UnknownName` or pydantic's `ValidationError`."""
        entry = self[name]
        return entry(entry.Parameters.model_validate(dict(parameters)))

    def __getitem__(self, name: str) -> type[E]:
        try:
            return self._entries[name]
        except KeyError:
            raise UnknownName(self.kind, name, list(self._entries)) from None

    def __contains__(self, name: object) -> bool:
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)
