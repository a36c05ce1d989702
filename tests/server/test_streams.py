import asyncio
import itertools

import pytest

from server.streams import Cadence, Publisher, StreamEnded, announcer, until_first_ends

pytestmark = pytest.mark.anyio


async def test_a_slow_reader_gets_the_newest_value_and_only_that():
    publisher = Publisher[int]()
    async with publisher.subscribe() as mailbox:
        for value in range(1000):
            publisher.publish(value)
        assert await mailbox.get() == 999
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(mailbox.get(), 0.01)


async def test_readers_have_slots_of_their_own():
    publisher = Publisher[str]()
    async with publisher.subscribe() as one, publisher.subscribe() as two:
        publisher.publish("a")
        assert await one.get() == "a"
        publisher.publish("b")
        assert (await one.get(), await two.get()) == ("b", "b")


async def test_a_newcomer_sees_the_last_value_at_once():
    publisher = Publisher[str]()
    publisher.publish("before")
    async with publisher.subscribe() as mailbox:
        assert await mailbox.get() == "before"


async def test_announcements_keep_the_latest_hundred_in_order_and_are_not_replayed():
    publisher = announcer()
    publisher.publish({"n": -1})
    async with publisher.subscribe() as mailbox:
        for n in range(250):
            publisher.publish({"n": n})
        assert [(await mailbox.get())["n"] for _ in range(100)] == list(range(150, 250))


async def test_closing_ends_every_stream_after_what_is_still_in_it():
    publisher = Publisher[int]()
    async with publisher.subscribe() as mailbox:
        publisher.publish(1)
        publisher.close()
        assert await mailbox.get() == 1
        with pytest.raises(StreamEnded):
            await mailbox.get()
    async with publisher.subscribe() as late:
        assert await late.get() == 1
        with pytest.raises(StreamEnded):
            await late.get()


async def test_a_reader_that_leaves_is_forgotten_even_when_it_fails():
    publisher = Publisher[int]()

    async def read():
        async with publisher.subscribe():
            assert publisher.subscribers == 1
            raise RuntimeError

    with pytest.raises(RuntimeError):
        await read()
    assert publisher.subscribers == 0


class Clock:
    """A clock that only sleeping moves on."""

    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now

    async def sleep(self, duration):
        self.now += duration


async def test_a_cadence_keeps_its_beat_when_each_value_takes_some_time():
    clock = Clock()
    cadence = Cadence(0.1, clock, clock.sleep)
    times = []
    for _ in range(50):
        await cadence.wait()
        times.append(clock.now)
        clock.now += 0.03
    assert times[-1] == pytest.approx(4.9)


async def test_a_cadence_does_not_catch_up_after_a_pause():
    clock = Clock()
    cadence = Cadence(0.1, clock, clock.sleep)
    await cadence.wait()
    clock.now = 10.0
    times = []
    for _ in range(4):
        await cadence.wait()
        times.append(clock.now)
    assert min(later - earlier for earlier, later in itertools.pairwise(times[1:])) >= 0.1 - 1e-9


async def test_the_first_to_end_takes_the_others_with_it():
    cancelled = asyncio.Event()

    async def forever():
        try:
            await asyncio.Event().wait()
        finally:
            cancelled.set()

    async def briefly():
        await asyncio.sleep(0)

    await until_first_ends(forever(), briefly())
    assert cancelled.is_set()


async def test_an_error_of_the_first_to_end_is_raised():
    async def fails():
        raise StreamEnded

    with pytest.raises(StreamEnded):
        await until_first_ends(asyncio.Event().wait(), fails())  # type: ignore[arg-type]
