"""The list of cameras, from real folders laid out as Linux lays its own out, and from real system calls."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from vision.sources import v4l_ioctl
from vision.sources.controls import apply
from vision.sources.listing import FoundCamera, find_cameras, identity_of, offers
from vision.sources.request import CameraError, CameraRequest
from vision.sources.v4l import check
from vision.sources.v4l_ioctl import Mode

MODES = [
    Mode("MJPG", (640, 480), (60.0, 30.0)),
    Mode("MJPG", (1920, 1080), (30.0,)),
    Mode("YUYV", (640, 480), (30.0,)),
]


class Computer:
    """A tree with /sys, /dev and /proc as far as they are looked at."""

    def __init__(self, root: Path) -> None:
        self.folder = root / "sys/class/video4linux"
        self.devices = root / "dev"
        self.processes = root / "proc"
        for place in (self.folder, self.devices / "v4l/by-id", self.processes):
            place.mkdir(parents=True)
        self._root = root
        self.asked: list[str] = []

    def plug_in(self, node: str, name: str, index: int, usb: tuple[str, str, str] | None = None) -> None:
        entry = self.folder / node
        entry.mkdir()
        (entry / "name").write_text(f"{name}\n")
        (entry / "index").write_text(f"{index}\n")
        (self.devices / node).touch()
        if usb is not None:
            self._usb(entry, *usb)

    def _usb(self, entry: Path, vendor: str, product: str, serial: str) -> None:
        interface = self._root / f"sys/devices/usb1/{vendor}-{product}/1.0"
        interface.mkdir(parents=True, exist_ok=True)
        for name, text in (("idVendor", vendor), ("idProduct", product), ("serial", serial)):
            if text:
                (interface.parent / name).write_text(f"{text}\n")
        (entry / "device").symlink_to(interface)

    def name_lastingly(self, node: str, name: str) -> None:
        (self.devices / "v4l/by-id" / name).symlink_to(f"../../{node}")

    def use(self, node: str) -> None:
        descriptors = self.processes / "4711/fd"
        descriptors.mkdir(parents=True)
        (descriptors / "3").symlink_to(self.devices / node)
        (descriptors / "4").symlink_to("socket:[1234]")

    def found(self, ask: Callable[[Path], list[Mode] | None]) -> list[FoundCamera]:
        def asking(device: Path) -> list[Mode] | None:
            self.asked.append(device.name)
            return ask(device)

        return find_cameras(self.folder, self.devices, asking, self.processes)


@pytest.fixture
def computer(tmp_path: Path) -> Computer:
    """A webcam with its metadata node, and a second camera that is no USB device."""
    computer = Computer(tmp_path)
    computer.plug_in("video10", "HD Webcam", 0, ("046d", "0825", "ABC123"))
    computer.plug_in("video11", "HD Webcam", 1, ("046d", "0825", "ABC123"))
    computer.plug_in("video2", "CSI camera", 0)
    computer.plug_in("vbi0", "teletext", 0)
    computer.name_lastingly("video10", "usb-046d_0825_ABC123-video-index0")
    return computer


def capture_nodes(device: Path) -> list[Mode] | None:
    return {"video10": MODES, "video2": []}.get(device.name)


def test_every_camera_is_listed_once_with_what_it_offers(computer: Computer) -> None:
    csi, webcam = computer.found(capture_nodes)
    assert csi == FoundCamera(
        f"v4l://{computer.devices}/video2",
        "CSI camera",
        "v4l CSI camera",
        f"{computer.devices}/video2",
        in_use=False,
    )
    assert webcam.name == "HD Webcam"
    assert webcam.identity == "usb 046d:0825 ABC123 HD Webcam"
    assert webcam.uri == f"v4l://{computer.devices}/v4l/by-id/usb-046d_0825_ABC123-video-index0"
    assert webcam.path == f"{computer.devices}/video10"
    assert webcam.sizes == ((1920, 1080), (640, 480))
    assert webcam.rates == (60.0, 30.0)


def test_a_camera_that_is_in_use_is_listed_and_not_opened(computer: Computer) -> None:
    computer.use("video10")
    webcam = computer.found(capture_nodes)[-1]
    assert (webcam.name, webcam.in_use, webcam.sizes) == ("HD Webcam", True, ())
    assert computer.asked == ["video2", "video11"]


def test_a_computer_without_cameras_lists_none(tmp_path: Path) -> None:
    assert find_cameras(tmp_path / "no/such", tmp_path, offers, tmp_path / "nor/this") == []


def test_an_identity_stays_when_the_camera_gets_another_number(computer: Computer, tmp_path: Path) -> None:
    moved = Computer(tmp_path / "later")
    moved.plug_in("video0", "HD Webcam", 0, ("046d", "0825", "ABC123"))
    before = identity_of(computer.devices / "video10", computer.folder)
    assert identity_of(moved.devices / "video0", moved.folder) == before


def test_a_camera_without_a_serial_number_is_known_by_maker_product_and_name(tmp_path: Path) -> None:
    computer = Computer(tmp_path)
    computer.plug_in("video0", "Cheap cam", 0, ("1234", "abcd", ""))
    assert computer.found(lambda _: [])[0].identity == "usb 1234:abcd Cheap cam"


# What the real kernel answers ---------------------------------------------------------------------


def test_a_device_that_is_no_camera_offers_nothing() -> None:
    assert offers(Path("/dev/null")) == []
    assert offers(Path("/dev/no-such-device")) == []
    with v4l_ioctl.opened(Path("/dev/null")) as descriptor:
        with pytest.raises(OSError, match="Inappropriate ioctl"):
            v4l_ioctl.gives_pictures(descriptor)
        assert v4l_ioctl.modes(descriptor) == []
        assert v4l_ioctl.control_range(descriptor, 0x00980913) is None
        settings = CameraRequest(exposure=0.01, gain=5.0, white_balance=4000.0)
        assert all("has no such setting" in words for words in apply(descriptor, settings))
        assert len(apply(descriptor, settings)) == 3
        assert apply(descriptor, CameraRequest()) == ()


@pytest.mark.parametrize(
    ("device", "says"),
    [
        ("/dev/no-such-device", "is not plugged in"),
        ("/dev/null", r"cannot be opened \(Inappropriate ioctl"),
        ("/etc/hostname", "is no camera"),
    ],
)
def test_what_is_no_camera_is_named_with_what_is_in_the_way(device: str, says: str) -> None:
    with pytest.raises(CameraError, match=says):
        check(Path(device))


def test_no_descriptor_stays_open() -> None:
    before = os.listdir("/proc/self/fd")
    offers(Path("/dev/null"))
    assert os.listdir("/proc/self/fd") == before


REQUESTS = {
    "VIDIOC_QUERYCAP": v4l_ioctl.QUERYCAP,
    "VIDIOC_ENUM_FMT": v4l_ioctl.ENUM_FMT,
    "VIDIOC_G_CTRL": v4l_ioctl.G_CTRL,
    "VIDIOC_S_CTRL": v4l_ioctl.S_CTRL,
    "VIDIOC_QUERYCTRL": v4l_ioctl.QUERYCTRL,
    "VIDIOC_ENUM_FRAMESIZES": v4l_ioctl.ENUM_FRAMESIZES,
    "VIDIOC_ENUM_FRAMEINTERVALS": v4l_ioctl.ENUM_FRAMEINTERVALS,
    "V4L2_CAP_VIDEO_CAPTURE": v4l_ioctl.VIDEO_CAPTURE,
    "V4L2_CAP_DEVICE_CAPS": v4l_ioctl.DEVICE_CAPS,
    "V4L2_FRMSIZE_TYPE_DISCRETE": v4l_ioctl.DISCRETE,
    "V4L2_FRMIVAL_TYPE_DISCRETE": v4l_ioctl.DISCRETE,
    "V4L2_CTRL_FLAG_DISABLED": v4l_ioctl.DISABLED,
    "V4L2_CID_GAIN": 0x00980913,
    "V4L2_CID_AUTOGAIN": 0x00980912,
    "V4L2_CID_AUTO_WHITE_BALANCE": 0x0098090C,
    "V4L2_CID_WHITE_BALANCE_TEMPERATURE": 0x0098091A,
    "V4L2_CID_EXPOSURE_AUTO": 0x009A0901,
    "V4L2_CID_EXPOSURE_ABSOLUTE": 0x009A0902,
    "V4L2_CID_EXPOSURE_AUTO_PRIORITY": 0x009A0903,
}


def test_the_numbers_are_those_of_the_kernel_s_header(tmp_path: Path) -> None:
    source = tmp_path / "numbers.c"
    lines = "".join(f'printf("%lu\\n", (unsigned long)(unsigned){name});' for name in REQUESTS)
    source.write_text(f"#include <stdio.h>\n#include <linux/videodev2.h>\nint main(void) {{{lines}}}\n")
    subprocess.run(["cc", "-o", tmp_path / "numbers", source], check=True)
    printed = subprocess.run([tmp_path / "numbers"], check=True, capture_output=True, text=True).stdout
    assert dict(zip(REQUESTS, map(int, printed.split()), strict=True)) == REQUESTS
