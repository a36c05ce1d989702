"""What the firmware shares with the host, written as a C++ header from the host's own definitions.

    python -m control.firmware.contract

writes `portable/contract.h`: codes and layouts of the messages, limits, fixed-point formats, the sine table.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from enum import IntEnum, IntFlag
from pathlib import Path

from control.link import messages, wire
from control.link.board_limits import CONFIGURATION_LIMITS
from control.simulation import coil_drive, fixed_point, regulator, twin

HEADER = Path(__file__).parent / "portable" / "contract.h"

_TYPES = {"B": "uint8_t", "b": "int8_t", "H": "uint16_t", "h": "int16_t", "I": "uint32_t", "i": "int32_t"}
_WORDS_A_LINE = 12


def rendered() -> str:
    """The whole header."""
    parts = (
        _OPENING,
        _constants(),
        _enumeration("Code", "uint8_t", ((layout.message.__name__, layout.code) for layout in wire.LAYOUTS)),
        *(_enum(members) for members in (messages.BoardCode, messages.Refusal, messages.ResetCause)),
        *(_flag(flag) for flag in messages.Flag),
        "",
        *(_structure(layout) for layout in wire.LAYOUTS),
        _allowed(),
        _sine(),
        _CLOSING,
    )
    return "\n".join(parts)


_OPENING = """\
// Written by `python -m control.firmware.contract` from the host's definitions: change those, not this.
#ifndef PIVOTRIG_CONTRACT_H
#define PIVOTRIG_CONTRACT_H

#include <stdint.h>

#include "flash.h"

namespace pivotrig {
"""

_CLOSING = """\
}  // namespace pivotrig

#endif
"""


def _constants() -> str:
    version = twin.FIRMWARE_VERSION
    values = (
        ("uint8_t", "protocol_version", wire.PROTOCOL_VERSION),
        *(("uint8_t", f"firmware_{part}", number) for part, number in _named(version)),
        ("uint16_t", "sequence_window", wire.SEQUENCE_WINDOW),
        ("uint8_t", "longest_frame", wire.LONGEST_FRAME),
        ("uint8_t", "transmit_buffer", twin.TRANSMIT_BUFFER),
        ("uint8_t", "telemetry_period", twin.TELEMETRY_PERIOD),
        ("uint8_t", "arm", messages.ARM),
        ("uint8_t", "allocation_bits", messages.ALLOCATION_ONE.bit_length() - 1),
        ("uint16_t", "sense_gain", messages.SENSE_GAIN),
        ("uint16_t", "full_count", regulator.FULL_COUNT),
        ("int16_t", "most_sensed", regulator.MOST_SENSED),
        ("int32_t", "integral_limit", regulator.INTEGRAL_LIMIT),
        ("uint8_t", "over_current_ticks", coil_drive.OVER_CURRENT_TICKS),
        ("uint16_t", "quarter_turn", fixed_point.QUARTER_TURN),
    )
    lines = [f"constexpr {kind} {name} = {value};" for kind, name, value in values]
    steps, scale = coil_drive.PWM_STEPS, coil_drive.DUTY_SCALE
    lines.append(f"constexpr uint16_t pwm_steps[3] = {_braces(steps)};")
    lines.append(f"constexpr uint16_t duty_scale[3] = {_braces(scale)};")
    return "\n".join(lines) + "\n"


def _named(version: messages.Triple) -> Iterable[tuple[str, int]]:
    return zip(("major", "minor", "patch"), version, strict=True)


def _enum(members: type[IntEnum]) -> str:
    pairs = ((_camel(member.name), member.value) for member in members)
    return _enumeration(members.__name__, "uint8_t", pairs)


def _enumeration(name: str, kind: str, members: Iterable[tuple[str, int]]) -> str:
    body = "\n".join(f"    {member} = {value}," for member, value in members)
    return f"enum class {name} : {kind} {{\n{body}\n}};\n"


def _flag(flag: IntFlag) -> str:
    return f"constexpr uint16_t {flag.name.lower()}_flag = {flag.value};" if flag.name else ""


def _structure(layout: wire.Layout) -> str:
    """A message's body as it lies on the wire; a message without a body has only its length."""
    name = layout.message.__name__
    length = f"constexpr uint8_t {_snake(name)}_length = {layout.format.size};\n"
    if not layout.fields:
        return length
    fields = "\n".join(f"    {_field(field, kind)}" for field, kind in layout.fields)
    check = f'static_assert(sizeof({name}) == {_snake(name)}_length, "lies as on the wire");\n'
    return f"{length}struct __attribute__((packed)) {name} {{\n{fields}\n}};\n{check}"


def _field(name: str, kind: str) -> str:
    count = kind[:-1]
    return f"{_TYPES[kind[-1]]} {name}[{count}];" if count else f"{_TYPES[kind]} {name};"


def _allowed() -> str:
    ranges = "\n".join(
        f"constexpr Range {name} = {_braces(limits)};" for name, limits in CONFIGURATION_LIMITS.items()
    )
    return f"""\
struct Range {{
    uint32_t low;
    uint32_t high;
}};

// Within these no intermediate of the arithmetic leaves 32 bits.
namespace allowed {{
{ranges}
}}
"""


def _sine() -> str:
    wave = [str(value) for value in fixed_point.QUARTER_WAVE]
    lines = [", ".join(wave[start : start + _WORDS_A_LINE]) for start in range(0, len(wave), _WORDS_A_LINE)]
    body = ",\n    ".join(lines)
    return f"constexpr int16_t quarter_wave[{len(wave)}] PIVOTRIG_FLASH = {{\n    {body},\n}};\n"


def _braces(values: Iterable[int]) -> str:
    return "{" + ", ".join(str(value) for value in values) + "}"


def _camel(name: str) -> str:
    return name.replace("_", " ").title().replace(" ", "")


def _snake(name: str) -> str:
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


if __name__ == "__main__":
    HEADER.write_text(rendered(), encoding="utf-8")
