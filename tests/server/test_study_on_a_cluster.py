"""One worker, two, or a Dask cluster: the same table, to the byte; and what goes wrong with a cluster, in words."""

import logging
import threading
import time

import pytest
from distributed import LocalCluster
from study_bench import definition, table_of

from control.studies import dask_crew
from server.studies.carrying_out import Workforce, carry_out_batch
from server.studies.store import StudyStore

pytestmark = [pytest.mark.exclusive, pytest.mark.leaves_threads]  # Dask keeps threads for the session

COMPILED = {"controller": "geometric", "plant": "slip", "gait.time_law": "path_step"}
PLAIN = [{**COMPILED, "gait.time_law": "wait"}, {**COMPILED, "controller": "straight", "plant": "noslip"}]
ALL = [
    {"controller": controller, "plant": plant, "gait.time_law": law}
    for controller in ("geometric", "gradient")
    for plant in ("slip", "noslip")
    for law in ("path_step", "wait")
]
"""Each kernel of the compiled ones takes every process seconds to load."""


@pytest.fixture(scope="module")
def cluster(full):
    with LocalCluster(
        n_workers=2 if full else 1,
        threads_per_worker=1,
        processes=True,
        dashboard_address=":0",
        silence_logs=logging.CRITICAL,
    ) as cluster:
        yield cluster


def test_the_table_is_the_same_whoever_does_the_work(cluster, tmp_path, full):
    sets = ALL if full else [COMPILED, *PLAIN]
    mixed = definition(6, design="list", axes=[], sets=sets)
    alone = table_of(tmp_path, mixed)
    assert alone.count(b",finished,") == len(sets) * 6
    assert table_of(tmp_path, mixed, jobs=2) == alone
    assert table_of(tmp_path, mixed, dask=cluster.scheduler_address) == alone


def test_a_study_whose_workers_are_lost_says_so_and_goes_on_elsewhere(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_crew, "WITHOUT_WORKERS", 0.5)
    monkeypatch.setattr(dask_crew, "LOOK", 0.1)
    wanted = definition(40)
    study = StudyStore(tmp_path).create(wanted)
    scaled = threading.Event()

    def lose(_progress):
        if not scaled.is_set():
            scaled.set()
            cluster.scale(0)

    carried = carry_out_batch(study, Workforce(dask=cluster.scheduler_address), lose)
    assert carried.state == study.state == "interrupted"
    assert "has had no worker for" in carried.reason
    assert "dask worker tcp://" in carried.reason
    assert 0 < study.tally().done < 120
    assert carry_out_batch(study, Workforce(1)).state == "finished"
    assert study.table().csv() == table_of(tmp_path / "whole", wanted)


def test_a_scheduler_that_goes_away_is_told_in_words(tmp_path, monkeypatch):
    monkeypatch.setattr(dask_crew, "WITHOUT_WORKERS", 0.5)
    monkeypatch.setattr(dask_crew, "LOOK", 0.1)
    study = StudyStore(tmp_path).create(definition(40))
    own = LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=":0"
    )
    gone = threading.Event()

    def close(_progress):
        if not gone.is_set():
            gone.set()
            own.close()

    began = time.monotonic()
    carried = carry_out_batch(study, Workforce(dask=own.scheduler_address), close)
    assert carried.state == "interrupted"
    assert "Dask" in carried.reason or "cluster" in carried.reason
    assert time.monotonic() - began < 60.0
