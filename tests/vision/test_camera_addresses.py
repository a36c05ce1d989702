"""Camera URIs: what they mean, what of them is shown, and what is said of those that mean nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vision.sources.addresses import Playback, device_of, playback_of, public, shown
from vision.sources.opening import CameraError, open_camera


@pytest.mark.parametrize(
    ("uri", "says"),
    [
        ("v4l://front", "allowed are"),
        ("v4l:///etc/passwd", "allowed are"),
        ("v4l://", "allowed are"),
        ("file:///nowhere/at/all.mp4", "missing"),
        ("file://", "names no path"),
        ("file:///x.mp4?pace=slow", "allowed is pace=own or pace=fast"),
        ("file:///x.mp4?loop=yes", "allowed is loop=0 or loop=1"),
        ("file:///x.mp4?rate=30", "allowed are loop, pace"),
        ("folder:///x?rate=0", "above 0"),
        ("folder:///x?rate=nan", "above 0"),
        ("folder:///x?rate=fast", "above 0"),
        ("folder:///x?speed=2", "allowed are loop, pace, rate"),
        ("rtsp://", "names no host"),
        ("http:///video", "names no host"),
        ("rtsp://[::1", "not understood"),
        ("sim://", "simulated"),
        ("ftp://10.0.0.1/", "allowed are"),
        ("0", "allowed are"),
        ("", "allowed are"),
    ],
)
def test_a_camera_that_is_not_understood_is_refused_with_what_is_allowed(uri: str, says: str) -> None:
    with pytest.raises(CameraError, match=says):
        open_camera(uri)


@pytest.mark.parametrize(
    ("uri", "device"),
    [
        ("v4l://0", "/dev/video0"),
        ("v4l://12", "/dev/video12"),
        ("v4l:///dev/video2", "/dev/video2"),
        (
            "v4l:///dev/v4l/by-id/usb-046d_0825_ABC-video-index0",
            "/dev/v4l/by-id/usb-046d_0825_ABC-video-index0",
        ),
        (
            "v4l:///dev/v4l/by-path/pci-0000:00:14.0-usb-0:3:1.0",
            "/dev/v4l/by-path/pci-0000:00:14.0-usb-0:3:1.0",
        ),
    ],
)
def test_a_v4l_camera_is_a_number_or_a_path(uri: str, device: str) -> None:
    assert device_of(uri) == Path(device)


@pytest.mark.parametrize(
    ("uri", "path"),
    [
        ("file:///films/x.mp4", "/films/x.mp4"),
        ("file://localhost/films/x.mp4", "/films/x.mp4"),
        ("file:films/x.mp4", "films/x.mp4"),
        ("file://films/x.mp4", "films/x.mp4"),
        ("file://x.mp4", "x.mp4"),
        ("file://../x.mp4", "../x.mp4"),
        ("file:///a%20film%20%231%20%3F.mp4", "/a film #1 ?.mp4"),
        ("file:///a film #1.mp4", "/a film #1.mp4"),
        ("file:///100% of it.mp4", "/100% of it.mp4"),
    ],
)
def test_a_file_may_be_relative_have_spaces_and_be_encoded(uri: str, path: str) -> None:
    assert playback_of(uri) == Playback(Path(path), None, fast=False, loop=False)


@given(st.text(st.characters(blacklist_characters="\0/", blacklist_categories=["Cs"]), min_size=1))
def test_every_name_of_a_file_can_be_written_as_a_uri(name: str) -> None:
    path = Path("/films") / name
    assert playback_of(path.as_uri()).path == path


@pytest.mark.parametrize(
    ("uri", "public_uri"),
    [
        ("rtsp://me:pw@10.0.0.2:554/live", "rtsp://***@10.0.0.2:554/live"),
        ("rtsp://me@10.0.0.2/live", "rtsp://***@10.0.0.2/live"),
        ("http://10.0.0.2/video?user=me&pwd=p@w&size=2", "http://10.0.0.2/video?user=***&pwd=***&size=2"),
        ("rtsp://dvr/user=me&password=p_w&channel=1.sdp", "rtsp://dvr/user=***&password=***&channel=1.sdp"),
        ("rtsp://dvr/User=me_Password=p_w_channel=1.sdp?real", "rtsp://dvr/User=***?real"),
        ("https://cam.lab/monkey=1/x?a=1", "https://cam.lab/monkey=1/x?a=1"),
        ("RTSP://me:p/w@host/x", "RTSP://***@host/x"),
        ("http://me:p?w@host/x", "http://***@host/x"),
        ("file:///home/me@work/x.mp4", "file:///home/me@work/x.mp4"),
        ("v4l://0", "v4l://0"),
    ],
)
def test_what_is_shown_of_a_uri_has_no_login(uri: str, public_uri: str) -> None:
    assert shown(uri) == public_uri


def test_a_network_camera_is_the_same_whoever_logs_in() -> None:
    for login in ("", "me:pw@", "you:other@"):
        assert public(f"rtsp://{login}cam.lab/live?stream=1&pwd=x") == "rtsp://cam.lab/live?stream=1"
    assert public("rtsp://dvr/user=me&password=x&channel=1") == public(
        "rtsp://dvr/user=you&password=y&channel=1"
    )
