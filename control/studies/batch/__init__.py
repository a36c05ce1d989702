"""Runs without pixels and bytes: the rig's own walk, controllers and robots, and compiled walks of the same laws."""

from control.studies.batch.outcome import Failed, RunFailed
from control.studies.batch.plain import Step, plain_walk
from control.studies.batch.simulation import simulate

__all__ = ["Failed", "RunFailed", "Step", "plain_walk", "simulate"]
