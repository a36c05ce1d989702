"""What is plugged in: boards on USB, the camera's device, and whether this user may open them."""

from __future__ import annotations

import grp
import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from control.link.discovery import AUTO, UsbPort, usb_ports
from control.link.opening import permission_advice
from server.diagnosis.check import Check, info, ok, problem
from server.settings import RigFile
from vision.sources.addresses import device_of
from vision.sources.request import CameraError


def examine(settings: RigFile) -> Iterator[Check]:
    ports = usb_ports()
    yield boards(ports, needed=is_device(settings.link.port) or settings.link.port == AUTO)
    for device in devices(settings, ports):
        yield permission(device)


def is_device(port: str) -> bool:
    return port.startswith("/")


def boards(ports: list[UsbPort], needed: bool) -> Check:
    known = [port.in_words for port in ports if port.board]
    others = [port.in_words for port in ports if not port.board]
    if known:
        return ok("USB boards", ", ".join(known))
    found = f"no board; other serial ports: {', '.join(others)}" if others else "no serial port on USB"
    if not needed:
        return info("USB boards", found)
    return info("USB boards", found, "connect the UNO by USB; a cable that only charges does not do")


def devices(settings: RigFile, ports: list[UsbPort]) -> list[str]:
    """The device files that this rig opens."""
    port = settings.link.port
    found = [port] if is_device(port) else [each.device for each in ports if port == AUTO and each.board]
    if settings.camera.uri.startswith("v4l:"):
        with suppress(CameraError):  # a URI that is not understood is told of where the camera is looked at
            found.append(str(device_of(settings.camera.uri)))
    return found


def permission(device: str) -> Check:
    name = f"permission {device}"
    try:
        node = os.stat(device)
    except OSError as error:
        return problem(name, f"{error.strerror or error}", "plug it in, or correct its name in the rig file")
    found = f"{stat.filemode(node.st_mode)}, group {group_name(node.st_gid)}"
    if os.access(device, os.R_OK | os.W_OK):
        return ok(name, f"may be opened ({found})")
    return problem(name, f"may not be opened ({found})", permission_advice(str(Path(device).resolve())))


def group_name(gid: int) -> str:
    try:
        return grp.getgrgid(gid).gr_name
    except KeyError:
        return str(gid)
