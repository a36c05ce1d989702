"""The handshake: boards that reset when their port is opened, that are old, other, deaf or configured wrongly."""

from __future__ import annotations

from dataclasses import replace

import pytest
from link_bench import COMMAND, CONFIGURATION

from control.link import wire
from control.link.conversion import LinkError, Telemetry
from control.link.messages import ARM, Banner, BoardCode, Configure, Drive, Hello, Refusal, Stop
from control.link.messages import Telemetry as Report
from control.link.session import BEHIND, LATE, RESEND, SILENCE, UNANSWERED, LinkState, Session
from control.simulation.twin import FirmwareTwin

MS = 1e-3
TICK = 16
AT_REST = (0, 0, 0)


class Conversation:
    """A session and the firmware's twin, with nothing between them but what a test puts there."""

    def __init__(self, boot_id: int = 7) -> None:
        self.now = 0.0
        self.session = Session(CONFIGURATION)
        self.board = FirmwareTwin(boot_id)
        self.board.transmit(999)
        self.heard: list[wire.Packet] = []
        self._decoder = wire.Decoder()
        self.session.open()

    def tell(self, data: bytes) -> None:
        self.heard += self._decoder.feed(data)
        self.board.receive(data)

    def tick(self, times: int = 1) -> Telemetry | None:
        report = None
        for _ in range(times):
            for _ in range(TICK):
                self.board.tick(AT_REST, 450)
            self.now += TICK * MS
            report = self.session.receive(self.board.transmit(999), self.now)
            if self.session.state is not LinkState.READY:
                self.tell(self.session.due(self.now))
        return report

    def be_silent(self, seconds: float) -> None:
        """The board's words are lost."""
        for _ in range(round(seconds / (TICK * MS))):
            self.now += TICK * MS
            self.session.receive(b"", self.now)
            if self.session.state is not LinkState.READY:
                self.session.due(self.now)

    def ready(self) -> Conversation:
        self.tick(5)
        assert self.session.state is LinkState.READY
        return self

    def report(self, sequence: int, **changes: object) -> bytes:
        """A report as the ready board would send it."""
        session = self.session
        fields = {
            **{"time": 1, "heading": 0, "elevation": 0, "commanded": AT_REST, "measured": AT_REST},
            **{"duty": AT_REST, "supply": 24000, "state": 1, "flags": 0, "last_sequence": session._sequence},
            **{"good": 9, "bad": 0, "refused": 0, "stale": 0, "last_refusal": 0},
            "configuration_hash": session._hash,
        }
        boot_id = changes.pop("boot_id", session.boot_id)
        assert isinstance(boot_id, int)
        return wire.encode(Report(**{**fields, **changes}), sequence, boot_id)  # type: ignore[arg-type]


def answered(session: Session, now: float, **changes: object) -> None:
    """The session's question, answered by a banner."""
    question = wire.Decoder().feed(session.due(now))[0]
    banner = Banner((0, 1, 0), 1, 0)
    session.receive(wire.encode(replace(banner, **changes), question.sequence, 7), now)  # type: ignore[arg-type]


def test_an_uno_that_resets_when_its_port_is_opened_is_greeted_when_it_has_booted() -> None:
    """Two seconds of bootloader, garbage for an answer; then the banner of the boot, and all goes fast."""
    talk = Conversation()
    while talk.now < 2.0:
        talk.now += TICK * MS
        hello = talk.session.due(talk.now)
        talk.session.receive(b"\x14\x10\x00\xfe" if hello else b"", talk.now)
    assert talk.session.state is LinkState.GREETING
    talk.board = FirmwareTwin(8)
    booted_at = talk.now
    while talk.session.state is not LinkState.READY:
        talk.tick()
    assert talk.now - booted_at <= 4 * TICK * MS
    assert talk.session.boot_id == 8
    assert talk.session.incident == ""


def test_garbage_of_a_bootloader_does_not_count_against_the_line() -> None:
    talk = Conversation()
    for _ in range(100):
        talk.session.receive(b"\x05\x00\x07\x00", talk.now)
    assert talk.session.broken_frames > 100
    talk.ready()
    assert talk.session.bad_share(talk.now) == 0.0


def test_a_board_that_resets_between_greeting_and_configuring_is_greeted_again() -> None:
    talk = Conversation()
    talk.tick(1)
    talk.board = FirmwareTwin(8)
    talk.ready()
    assert talk.session.boot_id == 8


def test_a_reset_whose_banner_is_lost_while_configuring_is_overcome() -> None:
    """A board that has not been greeted obeys no configuration and says nothing."""
    talk = Conversation()
    answered(talk.session, 0.0)
    assert talk.session.state is LinkState.CONFIGURING
    talk.board = FirmwareTwin(8)
    talk.board.transmit(999)
    talk.tick(round((UNANSWERED + 2) * RESEND / (TICK * MS)))
    assert talk.session.state is LinkState.READY
    assert talk.session.boot_id == 8


@pytest.mark.parametrize("noise", [b"", b"Grbl 1.1h\r\n"])
def test_a_port_where_nobody_answers_says_what_may_be_wrong(noise: bytes) -> None:
    session = Session(CONFIGURATION)
    session.open()
    for tick in range(250):
        session.receive(noise, tick * TICK * MS)
        session.due(tick * TICK * MS)
    assert ("something speaks" if noise else "nothing answers") in session.reason
    assert "firmware flash" in session.reason
    assert session.resends == 13
    with pytest.raises(LinkError, match="pivotrig doctor"):
        session.drive(COMMAND, 4.0)


def test_a_board_that_answers_late_is_ready_nevertheless() -> None:
    talk = Conversation()
    talk.be_silent(4.0)
    assert "nothing answers" in talk.session.reason
    talk.tick(25)
    assert talk.session.state is LinkState.READY
    assert talk.session.reason == ""


@pytest.mark.parametrize("version", [0, 2, 255])
def test_another_version_is_named_with_what_to_flash_and_never_ready(version: int) -> None:
    session = Session(CONFIGURATION)
    session.open()
    for tick in range(400):
        now = tick * TICK * MS
        for packet in wire.Decoder().feed(session.due(now)):
            assert packet.message == Hello()
            session.receive(wire.encode(Banner((3, 2, 1), 1, 0), packet.sequence, 5, version=version), now)
    assert session.state is LinkState.GREETING
    assert f"firmware 3.2.1 speaks protocol version {version}" in session.reason
    assert "firmware flash" in session.reason
    with pytest.raises(LinkError, match="flash"):
        session.drive(replace(COMMAND, start_heading=0.0), 9.0)


def test_a_board_that_suddenly_speaks_another_version_is_let_go_of() -> None:
    talk = Conversation().ready()
    talk.session.receive(wire.encode(Banner((9, 9, 9), 1, 0), 0, 8, version=9), talk.now)
    assert talk.session.state is LinkState.GREETING
    assert "9.9.9" in talk.session.reason


def test_another_configuration_than_ours_is_never_ready_and_says_so() -> None:
    session = Session(CONFIGURATION)
    session.open()
    answered(session, 0.0)
    for tick in range(1, 5):
        answered(session, tick * (RESEND + MS), configuration_hash=4711)
    assert session.state is LinkState.CONFIGURING
    assert "another configuration" in session.reason
    assert "0x1267" in session.reason
    with pytest.raises(LinkError, match="another configuration"):
        session.drive(replace(COMMAND, start_heading=0.0), 2.0)


@pytest.mark.parametrize(("refusal", "words"), [("CONFIGURATION", "outside its range"), ("STATE", "state")])
def test_a_refused_configuration_gives_the_reason(refusal: str, words: str) -> None:
    talk = Conversation()
    answered(talk.session, 0.0)
    talk.session.receive(talk.report(1, last_refusal=Refusal[refusal]), 0.01)
    assert talk.session.state is LinkState.CONFIGURING
    assert "refuses the configuration" in talk.session.reason
    assert words in talk.session.reason


def test_a_report_of_another_refusal_or_another_boot_explains_nothing() -> None:
    talk = Conversation()
    answered(talk.session, 0.0)
    talk.session.receive(talk.report(1, last_refusal=Refusal.SEQUENCE), 0.01)
    talk.session.receive(talk.report(2, last_refusal=Refusal.STATE, boot_id=99), 0.01)
    assert talk.session.reason == "configuring the board"


def test_a_repeated_answer_to_the_hello_is_no_answer_to_the_configuration() -> None:
    """Its hash is that of a configuration that the board was given before the one that is on its way."""
    session = Session(CONFIGURATION)
    session.open()
    hello = wire.Decoder().feed(session.due(0.0))[0]
    banner = wire.encode(Banner((0, 1, 0), 1, session._hash), hello.sequence, 7)
    session.receive(banner + banner, 0.01)
    assert session.state is LinkState.CONFIGURING
    assert [type(p.message) for p in wire.Decoder().feed(session.due(0.02))] == [Configure]
    session.receive(banner, 0.03)
    assert session.state is LinkState.CONFIGURING


def test_a_banner_of_a_ready_board_changes_nothing() -> None:
    talk = Conversation().ready()
    talk.session.receive(wire.encode(Banner((0, 1, 0), 1, 0), 99, talk.session.boot_id), talk.now)
    assert talk.session.state is LinkState.READY


@pytest.mark.parametrize("word", ["banner", "report"])
def test_a_new_boot_id_is_an_incident_until_the_next_arm_edge(word: str) -> None:
    talk = Conversation().ready()
    if word == "banner":
        talk.session.receive(wire.encode(Banner((0, 1, 0), 1, 0), 0, 8), talk.now)
    else:
        talk.session.receive(talk.report(9, boot_id=8), talk.now)
    assert talk.session.state is LinkState.GREETING
    assert "boot id 7 -> 8" in talk.session.incident
    with pytest.raises(LinkError, match="boot id 7 -> 8"):
        talk.session.drive(COMMAND, talk.now)
    talk.board = FirmwareTwin(8)
    talk.ready()
    talk.tell(talk.session.drive(COMMAND, talk.now))
    assert talk.board.state is BoardCode.READY
    assert talk.session.incident
    talk.tell(talk.session.drive(replace(COMMAND, start_heading=0.0), talk.now))
    assert talk.board.state is BoardCode.DRIVING
    assert talk.session.incident == ""


def test_a_board_without_our_configuration_is_an_incident() -> None:
    talk = Conversation().ready()
    talk.session.receive(talk.report(9, configuration_hash=1), talk.now)
    assert "lost its configuration" in talk.session.incident


def test_a_lost_port_is_no_incident() -> None:
    """It disarms by itself for as long as it is lost; the board that comes back is greeted like a new one."""
    talk = Conversation().ready()
    talk.session.lose("unplugged")
    assert (talk.session.state, talk.session.reason) == (LinkState.CLOSED, "unplugged")
    assert talk.session.incident == ""
    assert talk.session.due(99.0) == b""


def test_silence_is_an_incident_after_half_a_second_and_not_before() -> None:
    talk = Conversation().ready()
    heard_at = talk.session._heard_at
    talk.session.receive(b"", heard_at + SILENCE)
    assert talk.session.state is LinkState.READY
    talk.session.receive(b"", heard_at + SILENCE + 1e-6)
    assert "no telemetry" in talk.session.incident


def test_a_repeated_or_late_report_is_no_news_and_breaks_no_silence() -> None:
    talk = Conversation().ready()
    number = talk.session._reported
    assert number is not None
    for sequence in (number, number - 1, (number - 32767) % 65536):
        assert talk.session.receive(talk.report(sequence), talk.now) is None
    for sequence in (number + 1, number + 1 + 32767):
        assert talk.session.receive(talk.report(sequence), talk.now) is not None
    talk.session.receive(talk.report(number), talk.now + SILENCE + 1e-6)
    assert "no telemetry" in talk.session.incident


def test_messages_that_the_board_does_not_hear_break_the_conversation_off_in_time() -> None:
    talk = Conversation().ready()
    number = talk.session._reported
    assert number is not None
    heard = talk.session._sequence
    for sent in range(1, BEHIND + 2):
        talk.session.drive(COMMAND, talk.now)
        talk.session.receive(talk.report(number + sent, last_sequence=heard), talk.now)
        assert (talk.session.state is LinkState.READY) is (sent <= BEHIND)
    assert f"missed the last {BEHIND + 1} messages" in talk.session.incident


def test_a_reports_frame_that_was_cut_by_a_lost_port_is_not_completed_by_the_next_one() -> None:
    talk = Conversation().ready()
    report = talk.report(500)
    talk.session.receive(report[:20], talk.now)
    talk.session.lose("unplugged")
    talk.session.open()
    talk.session.receive(report[20:], talk.now)
    assert talk.session.broken_frames == 1


def test_only_an_arm_edge_carries_the_arm_flag_and_the_numbers_rise_by_one() -> None:
    talk = Conversation().ready()
    frames = [talk.session.drive(replace(COMMAND, start_heading=0.0), talk.now), talk.session.stop()]
    frames += [talk.session.drive(COMMAND, talk.now) for _ in range(5)]
    packets = wire.Decoder().feed(b"".join(frames))
    assert [p.sequence - packets[0].sequence for p in packets] == list(range(7))
    assert [isinstance(p.message, Stop) for p in packets] == [False, True, *[False] * 5]
    assert [p.message.flags for p in packets if isinstance(p.message, Drive)] == [ARM, *[0] * 5]


def test_the_numbers_go_round_without_a_zero() -> None:
    talk = Conversation().ready()
    talk.session._sequence = 65534
    numbers = [wire.Decoder().feed(talk.session.stop())[0].sequence for _ in range(3)]
    assert numbers == [65535, 1, 2]


def test_a_round_trip_is_timed_one_at_a_time() -> None:
    talk = Conversation().ready()
    number, session = talk.session._reported, talk.session
    assert number is not None
    session.drive(COMMAND, 10.0)
    sent = session._sequence
    session.drive(COMMAND, 10.005)
    session.receive(talk.report(number + 1, last_sequence=sent - 1), 10.01)
    assert session.echoes.round_trips.newest is None
    session.receive(talk.report(number + 2, last_sequence=sent), 10.03)
    assert session.echoes.round_trips.newest == pytest.approx(0.03)


def test_a_board_that_hears_commands_late_gets_none_before_the_next_arm_edge() -> None:
    """A stop would be as late as they are."""
    talk = Conversation().ready()
    number, session = talk.session._reported, talk.session
    assert number is not None
    session.drive(COMMAND, 0.0)
    deaf = session._sequence - 1
    session.drive(COMMAND, LATE)
    with pytest.raises(LinkError, match=r"not heard a command for 0\.31 s"):
        session.drive(COMMAND, 0.31)
    assert session._sequence == deaf + 2
    session.drive(replace(COMMAND, start_heading=0.0), 21.0)
    session._heard_at = 21.0
    session.receive(talk.report(number + 3, last_sequence=session._sequence), 21.05)
    assert session.echoes.round_trips.newest == pytest.approx(0.05)


def test_a_message_that_only_a_host_sends_is_no_word_of_the_board() -> None:
    talk = Conversation().ready()
    for message in (Hello(), Stop()):
        talk.session.receive(wire.encode(message, 99, 8), talk.now)
    assert talk.session.state is LinkState.READY
