"""Laws of the wire: what goes in comes out, broken bytes never do, and the cuts of a stream do not matter."""

from __future__ import annotations

from binascii import crc_hqx
from dataclasses import fields, replace

import pytest
from cobs import cobs
from hypothesis import given, settings
from hypothesis import strategies as st

from control.link.messages import Banner, Configure, Drive, Hello, Message, Stop, Telemetry
from control.link.wire import (
    LONGEST_FRAME,
    Decoder,
    Packet,
    WireError,
    configuration_hash,
    encode,
    sequence_distance,
)

QUICK = settings(max_examples=150, deadline=None, derandomize=True)
u8, u16, u32 = st.integers(0, 2**8 - 1), st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1)
i8, i16, i32 = (
    st.integers(-(2**7), 2**7 - 1),
    st.integers(-(2**15), 2**15 - 1),
    st.integers(-(2**31), 2**31 - 1),
)
u16x6 = st.tuples(*[u16] * 6)
u16x3, i16x3, i16x9 = st.tuples(u16, u16, u16), st.tuples(i16, i16, i16), st.tuples(*[i16] * 9)

hellos = st.just(Hello())
stops = st.just(Stop())
banners = st.builds(Banner, st.tuples(u8, u8, u8), u8, u16)
configures = st.builds(Configure, u16x3, u16, u16, u16, u16x3, u16x3, u16, u16, u32, u16, u16x6, u16)
drives = st.builds(Drive, u8, i8, i32, u32, u32, u16, u16, i16x9, u16)
telemetries = st.builds(
    Telemetry, u32, u32, i16, i16x3, i16x3, i16x3, u16, u8, u16, u16, u16, u16, u16, u16, u8, u16
)
messages = st.one_of(hellos, stops, banners, configures, drives, telemetries)

DRIVE = Drive(1, -1, -1367131, 4026531840, 17, 4551, 10000, (13107, 0, -5, 1, 13107, 0, 0, 256, 13107), 120)
TELEMETRY = Telemetry(
    *(100000, 3221225472, -4551, (6000, -30, 0), (5980, -35, 0), (20000, 0, -256), 24000),
    *(2, 8, 4711, 6000, 3, 2, 1, 7, 0xBEEF),
)
CONFIGURE = Configure(
    *(
        (8000, 8000, 8000),
        200,
        50,
        8533,
        (2500, 2000, 1500),
        (12500, 5500, 1400),
        24000,
        20000,
        1367131,
        10923,
    ),
    *((8929, 8929, 9100, 8700, 8929, 11161), 55000),
)
EXAMPLES = (Hello(), Stop(), Banner((0, 1, 0), 1, 0x1234), CONFIGURE, DRIVE, TELEMETRY)


def decoded(data: bytes) -> list[Packet]:
    return Decoder().feed(data)


@given(messages, u16, u16)
@QUICK
def test_a_message_comes_out_as_it_went_in(message: Message, sequence: int, boot_id: int) -> None:
    assert decoded(encode(message, sequence, boot_id)) == [Packet(1, sequence, boot_id, message)]


@given(messages, u16, u16)
@QUICK
def test_a_frame_is_delimited_by_zeros_and_has_none_inside(
    message: Message, sequence: int, boot_id: int
) -> None:
    frame = encode(message, sequence, boot_id)
    assert frame[0] == frame[-1] == 0
    assert 0 not in frame[1:-1]
    assert len(frame) - 2 <= LONGEST_FRAME


def test_the_bytes_of_a_drive_are_the_documented_ones() -> None:
    """Fixed bytes, so that another implementation has something to agree with."""
    payload = bytes.fromhex(
        "04 01 0200 0300"  # type, version, sequence 2, boot id 3
        "01 ff a523ebff 000000f0 11000000 c711 1027"
        "3333 0000 fbff 0100 3333 0000 0000 0001 3333 7800"
    )
    crc = crc_hqx(payload, 0xFFFF).to_bytes(2, "little")
    assert encode(DRIVE, 2, 3) == b"\0" + cobs.encode(payload + crc) + b"\0"


@pytest.mark.parametrize("message", EXAMPLES, ids=lambda m: type(m).__name__)
@pytest.mark.parametrize("header", [(1, 1), (0, 0), (65535, 256), (4660, 22136)])
def test_every_single_wrong_bit_is_rejected(message: Message, header: tuple[int, int]) -> None:
    frame = encode(message, *header)
    for bit in range(8 * len(frame)):
        broken = bytearray(frame)
        broken[bit // 8] ^= 1 << (bit % 8)
        assert decoded(bytes(broken)) == []


@given(messages, st.data())
@QUICK
def test_a_wrong_bit_in_any_message_is_rejected(message: Message, data: st.DataObject) -> None:
    frame = bytearray(encode(message, 77, 88))
    bit = data.draw(st.integers(0, 8 * len(frame) - 1))
    frame[bit // 8] ^= 1 << (bit % 8)
    assert decoded(bytes(frame)) == []


@given(
    st.lists(st.one_of(messages.map(lambda m: encode(m, 5, 6)), st.binary(max_size=90)), max_size=8),
    st.data(),
)
@QUICK
def test_a_stream_parses_alike_however_it_is_cut(pieces: list[bytes], data: st.DataObject) -> None:
    stream = b"".join(pieces)
    whole, cut = Decoder(), Decoder()
    expected = whole.feed(stream)
    places = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=12)))
    found: list[Packet] = []
    for start, end in zip([0, *places], [*places, len(stream)], strict=True):
        found += cut.feed(stream[start:end])
    assert found == expected
    assert vars(cut) == vars(whole)


@given(st.lists(st.tuples(st.binary(max_size=200), messages), min_size=1, max_size=6))
@QUICK
def test_garbage_between_messages_loses_none_of_them(pairs: list[tuple[bytes, Message]]) -> None:
    stream = b"".join(garbage + encode(message, 9, 9) for garbage, message in pairs)
    heard = [packet.message for packet in decoded(stream)]
    for _, message in pairs:
        assert message in heard
    assert len(heard) == len(pairs)


@given(st.binary(max_size=5000))
@QUICK
def test_garbage_is_never_an_exception_and_never_a_message(data: bytes) -> None:
    decoder = Decoder()
    assert decoder.feed(data) == []
    assert len(decoder._partial) <= LONGEST_FRAME


def test_bytes_without_an_end_keep_the_buffer_bounded_and_count_once() -> None:
    decoder = Decoder()
    for _ in range(1000):
        decoder.feed(b"\x05" * 50)
    assert len(decoder._partial) <= LONGEST_FRAME
    assert decoder.oversize == 1
    assert [p.message for p in decoder.feed(encode(Hello(), 1, 1))] == [Hello()]


def framed(payload: bytes, crc: int | None = None) -> bytes:
    check = crc_hqx(payload, 0xFFFF) if crc is None else crc
    return b"\0" + cobs.encode(payload + check.to_bytes(2, "little")) + b"\0"


@pytest.mark.parametrize(
    ("frame", "counter"),
    [
        (b"\0\x09ab\0", "bad_cobs"),
        (framed(b"\x01\x01\0\0\0\0", crc=0), "bad_crc"),
        (b"\0" + b"\x01" * 65 + b"\0", "oversize"),
        (framed(b"\x01\x01\0\0\0\0\0"), "wrong_length"),
        (framed(b"\x04\x01\0\0\0\0"), "wrong_length"),
        (framed(b"ab"), "wrong_length"),
        (framed(b"\x00\x01\0\0\0\0"), "unknown_type"),
        (framed(b"\x07\x01\0\0\0\0"), "unknown_type"),
        (encode(DRIVE, 1, 1, version=2), "wrong_version"),
        (encode(Stop(), 1, 1, version=0), "wrong_version"),
    ],
)
def test_each_kind_of_broken_frame_has_its_counter(frame: bytes, counter: str) -> None:
    decoder = Decoder()
    assert decoder.feed(frame) == []
    assert getattr(decoder, counter) == 1
    assert decoder.dropped == 1


def test_hello_and_banner_are_understood_in_every_version() -> None:
    for message in (Hello(), Banner((9, 9, 9), 1, 0)):
        assert decoded(encode(message, 1, 2, version=200)) == [Packet(200, 1, 2, message)]


@pytest.mark.parametrize(
    "message",
    [
        replace(DRIVE, field=65536),
        replace(DRIVE, field=-1),
        replace(DRIVE, pivot=128),
        replace(DRIVE, rate=2**31),
        replace(DRIVE, allocation=(0, 0, 0, 0, 0, 0, 0, 0, 32768)),
        replace(DRIVE, field=0.5),  # type: ignore[arg-type]
        replace(CONFIGURE, current_limits=(8000, 8000, 70000)),
    ],
)
def test_a_value_that_does_not_fit_is_refused_by_name(message: Message) -> None:
    with pytest.raises(WireError, match="does not fit the wire"):
        encode(message, 1, 1)


@pytest.mark.parametrize("header", [(65536, 0), (-1, 0), (0, 65536), (0, -1)])
def test_a_header_that_does_not_fit_is_refused(header: tuple[int, int]) -> None:
    with pytest.raises(WireError, match="header"):
        encode(Hello(), *header)


def test_every_field_of_a_configuration_counts_in_its_hash() -> None:
    def bumped(value: int | tuple[int, ...]) -> int | tuple[int, ...]:
        return (*value[:-1], value[-1] + 1) if isinstance(value, tuple) else value + 1

    changed = [
        configuration_hash(replace(CONFIGURE, **{f.name: bumped(getattr(CONFIGURE, f.name))}))
        for f in fields(CONFIGURE)
    ]
    assert len({configuration_hash(CONFIGURE), *changed}) == len(changed) + 1
    assert 0 not in changed


@given(u16, st.integers(0, 65535))
def test_the_distance_of_sequence_numbers_goes_round(start: int, ahead: int) -> None:
    assert sequence_distance((start + ahead) % 65536, start) == ahead


@pytest.mark.parametrize("begun", [b"\x05abc", b"x" * 200])
def test_a_decoder_that_starts_anew_forgets_what_had_begun_and_keeps_its_counts(begun: bytes) -> None:
    decoder = Decoder()
    decoder.feed(b"\0\x02\x01\0" + begun)
    counted = decoder.dropped
    decoder.restart()
    [packet] = decoder.feed(encode(DRIVE, 7, 9)[1:])
    assert (packet.message, packet.sequence, packet.boot_id) == (DRIVE, 7, 9)
    assert decoder.dropped == counted >= 1


@pytest.mark.parametrize(("cut", "size", "oversize"), [(0, 64, 0), (0, 65, 1), (1, 64, 0), (1, 65, 1)])
def test_a_frame_may_be_as_long_as_the_boards_buffer_and_no_longer(
    cut: int, size: int, oversize: int
) -> None:
    decoder = Decoder()
    frame = b"\x01" * size
    decoder.feed(frame + b"\0" if cut == 0 else frame)
    decoder.feed(b"" if cut == 0 else b"\0")
    assert (decoder.oversize, decoder.dropped) == (oversize, 1)


def test_every_broken_frame_is_counted_again() -> None:
    good = encode(Stop(), 3, 4)
    frames = {
        "bad_cobs": b"\x09abc\0",
        "bad_crc": cobs.encode(bytes(10)) + b"\0",
        "wrong_length": cobs.encode(b"ab") + b"\0",
        "oversize": b"\x01" * 70 + b"\0",
        "unknown_type": _frame(bytes((77, 1, 0, 0, 0, 0))),
        "wrong_version": encode(Stop(), 3, 4, version=9),
    }
    decoder = Decoder()
    for _ in range(3):
        for frame in frames.values():
            assert decoder.feed(b"\0" + frame) == []
    decoder.feed(b"x" * 80)
    decoder.feed(b"x" * 80)
    assert {name: getattr(decoder, name) for name in frames} == dict.fromkeys(frames, 3) | {"oversize": 4}
    decoder.feed(b"\0" + _frame(bytes((5, 1, 0, 0, 0, 0, 1))) * 2)
    assert decoder.wrong_length == 5
    assert [packet.message for packet in decoder.feed(good)] == [Stop()]


def _frame(payload: bytes) -> bytes:
    return cobs.encode(payload + crc_hqx(payload, 0xFFFF).to_bytes(2, "little")) + b"\0"


def test_the_hash_is_the_crc_of_the_bytes_that_travel_and_never_none() -> None:
    body = cobs.decode(encode(CONFIGURE, 1, 1)[1:-1])[6:-2]
    assert configuration_hash(CONFIGURE) == crc_hqx(body, 0xFFFF)
    assert crc_hqx(b"123456789", 0xFFFF) == 0x29B1, "the check value of this CRC"


@pytest.mark.parametrize(("header", "named"), [((65536, 0), "sequence 65536"), ((1, -1), "boot id -1")])
def test_a_refused_header_is_named(header: tuple[int, int], named: str) -> None:
    with pytest.raises(WireError, match=named):
        encode(Hello(), *header)


def configuration_whose_sum_is_zero() -> Configure:
    """The low 16 bits of a field reach every value of a CRC of 16 bits exactly once."""
    for low in range(65536):
        candidate = replace(CONFIGURE, max_rate=(1 << 20) + low)
        if crc_hqx(cobs.decode(encode(candidate, 1, 1)[1:-1])[6:-2], 0xFFFF) == 0:
            return candidate
    raise AssertionError("a CRC that skips a value")


def test_a_configuration_whose_sum_is_zero_is_told_from_none() -> None:
    assert configuration_hash(configuration_whose_sum_is_zero()) == 1
