"""Measuring a rig: camera, gait, latency."""
