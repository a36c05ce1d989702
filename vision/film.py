"""Pictures to a film: H.264 in an MP4 that browsers play, each picture shown when it was taken."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

import av
import cv2
import numpy as np
from av.container import OutputContainer
from av.video.stream import VideoStream
from cv2.typing import MatLike
from numpy.typing import NDArray

TICKS_PER_SECOND = 10_000
"""Of a film's clock: far finer than a camera's jitter, and from one picture to the next there may be 2^31 of them (two
days) in an MP4. With video's usual 90 000 the camera of a held run could not be away for seven hours."""
NOMINAL_RATE = 30
"""What the film states as its rate, frames/s; the true times are those of its pictures."""
KEY_PICTURE_EVERY = 50
"""Pictures from one that stands for itself to the next: 5 s to jump by at 10 pictures/s."""
FRAGMENT_US = 1_000_000
"""Length of one piece of a film that is sent while it is made, microseconds."""
QUALITY = {"preset": "veryfast", "crf": "21", "bf": "0"}
"""x264's scale: nothing that a person sees is lost, at a third of the time of its default. No picture refers to a
later one (bf 0), since that would put off the beginning of a film in fragments."""


class Sink(Protocol):
    """Takes bytes one after the other, as a connection does: nobody can go back in it."""

    def write(self, data: bytes, /) -> object: ...


class FilmError(ValueError):
    """A picture that cannot become part of a film; the text says what is wrong with it."""


class Film:
    """A film that is being made: pictures of one size (BGR), in the order of their times.

    Raises OSError when it cannot be written.
    """

    def __init__(self, container: OutputContainer) -> None:
        self._container = container
        self._stream: VideoStream | None = None
        self._shape: tuple[int, ...] = ()
        self._start = 0.0
        self._last = -1
        self.pictures = 0

    def add(self, image: MatLike, time: float) -> None:
        """time: when the picture was taken, s; the first one is where the film begins.

        A picture that is no later than the one before is shown a moment after it.
        """
        stream = self._stream or self._begin(image, time)
        if image.shape != self._shape:
            raise FilmError(
                f"a picture of {image.shape[1]} x {image.shape[0]} px cannot follow one of "
                f"{self._shape[1]} x {self._shape[0]} px in the same film"
            )
        frame = av.VideoFrame.from_ndarray(_even(image), format="bgr24").reformat(format="yuv420p")
        self._last = max(round((time - self._start) * TICKS_PER_SECOND), self._last + 1)
        frame.pts, frame.time_base = self._last, Fraction(1, TICKS_PER_SECOND)
        self._container.mux(stream.encode(frame))
        self.pictures += 1

    def finish(self) -> None:
        """Write what the encoder still holds; a film without a picture stays empty."""
        if self._stream is not None:
            self._container.mux(self._stream.encode(None))

    def _begin(self, image: MatLike, time: float) -> VideoStream:
        if image.ndim != 3 or image.shape[2] != 3 or image.dtype != np.uint8:
            raise FilmError(
                f"a film is made of colour pictures of bytes, not of {image.dtype} of shape {image.shape}"
            )
        self._shape, self._start = image.shape, time
        height, width = _even(image).shape[:2]
        self._stream = self._container.add_stream("libx264", rate=NOMINAL_RATE, options=QUALITY)
        self._stream.width, self._stream.height = width, height
        self._stream.pix_fmt = "yuv420p"
        self._stream.gop_size = KEY_PICTURE_EVERY
        self._stream.time_base = Fraction(1, TICKS_PER_SECOND)
        self._stream.codec_context.time_base = Fraction(1, TICKS_PER_SECOND)
        return self._stream


@contextmanager
def film_file(path: Path) -> Iterator[Film]:
    """A film in a file, its index in front, so that a browser can start to play before it has all of it.

    By the whole path: of a name alone FFmpeg would take what stands before a colon for a protocol.
    """
    with _opened(str(path.absolute()), {"movflags": "+faststart"}) as film:
        yield film


@contextmanager
def film_stream(sink: Sink) -> Iterator[Film]:
    """A film in fragments, each complete."""
    pieces = {
        "movflags": "+frag_keyframe+empty_moov+default_base_moof",
        "frag_duration": str(FRAGMENT_US),
    }
    with _opened(sink, pieces) as film:
        yield film


@contextmanager
def _opened(place: Any, options: dict[str, str]) -> Iterator[Film]:
    with av.open(place, "w", format="mp4", options=options) as container:
        film = Film(container)
        yield film
        film.finish()


def _even(image: MatLike) -> NDArray[np.uint8]:
    """The picture with its last row and column repeated where their number is odd: H.264 halves the colours."""
    height, width = image.shape[:2]
    if not (height % 2 or width % 2):
        return np.ascontiguousarray(image, np.uint8)
    padded = cv2.copyMakeBorder(image, 0, height % 2, 0, width % 2, cv2.BORDER_REPLICATE)
    return np.asarray(padded, np.uint8)


def decode_jpeg(jpeg: bytes) -> MatLike | None:
    """The picture (height, width, 3), BGR; None for bytes that are none."""
    if not jpeg:
        return None
    return cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
