"""The cameras of this computer: what Linux tells of them, and what they offer. None that is in use is opened."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from vision.sources import v4l_ioctl
from vision.sources.request import Size

CLASS = Path("/sys/class/video4linux")
DEVICES = Path("/dev")
PROCESSES = Path("/proc")
USB_ATTRIBUTES = ("idVendor", "idProduct")


@dataclass(frozen=True, slots=True)
class FoundCamera:
    """uri: to open it by, which lasts over replugging where there is such a name.  identity: what tells it from
    others, wherever it is plugged in.  in_use: a program of this user has it open.
    sizes: px, the largest first; rates: frames/s, the highest first; () when not known."""

    uri: str
    name: str
    identity: str
    path: str
    in_use: bool
    sizes: tuple[Size, ...] = ()
    rates: tuple[float, ...] = ()


def find_cameras(
    folder: Path = CLASS,
    devices: Path = DEVICES,
    ask: Callable[[Path], list[v4l_ioctl.Mode] | None] | None = None,
    processes: Path = PROCESSES,
) -> list[FoundCamera]:
    """Every camera that Linux lists, by number.

    folder, devices, processes: where Linux shows its video devices, their nodes, and who has them open.
    ask: what a node offers, None for one that gives no pictures.
    """
    used = _open_files(processes)
    found = []
    for entry in sorted(_entries(folder), key=lambda entry: _number(entry.name)):
        camera = _camera(entry, devices, used, ask or offers)
        if camera is not None:
            found.append(camera)
    return found


def offers(device: Path) -> list[v4l_ioctl.Mode] | None:
    """What the camera behind a node offers, [] when it does not say; None for a node that gives no pictures."""
    try:
        with v4l_ioctl.opened(device) as descriptor:
            return v4l_ioctl.modes(descriptor) if v4l_ioctl.gives_pictures(descriptor) else None
    except OSError:
        return []


def identity_of(device: Path, folder: Path = CLASS) -> str:
    """What tells this camera from others: maker, product, serial number and name; not where it is plugged in."""
    entry = folder / device.resolve().name
    usb = _usb_device(entry)
    numbers = ":".join(_text(usb / name) for name in USB_ATTRIBUTES) if usb else ""
    kind = f"usb {numbers}" if usb else "v4l"
    serial = _text(usb / "serial") if usb else ""
    return " ".join(part for part in (kind, serial, _text(entry / "name")) if part)


def _camera(
    entry: Path, devices: Path, used: frozenset[str], ask: Callable[[Path], list[v4l_ioctl.Mode] | None]
) -> FoundCamera | None:
    device = devices / entry.name
    in_use = str(device.resolve()) in used
    modes = ([] if _text(entry / "index") in ("", "0") else None) if in_use else ask(device)
    if modes is None:
        return None
    lasting = _lasting_name(device, devices)
    return FoundCamera(
        uri=f"v4l://{lasting or device}",
        name=_text(entry / "name") or entry.name,
        identity=identity_of(device, entry.parent),
        path=str(device),
        in_use=in_use,
        sizes=tuple(sorted({mode.size for mode in modes}, key=lambda size: -size[0] * size[1])),
        rates=tuple(sorted({round(rate, 3) for mode in modes for rate in mode.rates}, reverse=True)),
    )


def _entries(folder: Path) -> Iterator[Path]:
    """Video devices alone: radio and vertical-blanking nodes are listed with them."""
    try:
        yield from (entry for entry in folder.iterdir() if entry.name.startswith("video"))
    except OSError:
        return


def _number(name: str) -> int:
    digits = name.removeprefix("video")
    return int(digits) if digits.isdecimal() else 0


def _usb_device(entry: Path) -> Path | None:
    """The folder of the USB device that the node belongs to, a few levels above it."""
    start = (entry / "device").resolve()
    for place in (start, *list(start.parents)[:4]):
        if all((place / name).is_file() for name in USB_ATTRIBUTES):
            return place
    return None


def _lasting_name(device: Path, devices: Path) -> Path | None:
    """The name under which Linux will find this very camera again; None where there is none."""
    target = device.resolve()
    try:
        names = sorted((devices / "v4l" / "by-id").iterdir())
    except OSError:
        return None
    return next((name for name in names if name.resolve() == target), None)


def _open_files(processes: Path) -> frozenset[str]:
    """Files that programs have open, as far as this user may know."""
    return frozenset(target for process in _processes(processes) for target in _files_of(process))


def _processes(processes: Path) -> list[Path]:
    try:
        return [entry for entry in processes.iterdir() if entry.name.isdecimal()]
    except OSError:
        return []


def _files_of(process: Path) -> Iterator[str]:
    try:
        descriptors = list((process / "fd").iterdir())
    except OSError:
        return
    for descriptor in descriptors:
        try:
            yield os.readlink(descriptor)
        except OSError:  # closed meanwhile
            continue


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return ""
