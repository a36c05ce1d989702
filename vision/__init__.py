"""Pixels to pose: camera sources, calibration, detection, tracking, the synthetic camera, encoding."""
