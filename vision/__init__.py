"""Pixels to pose: camera sources, calibration, detection, tracking, the synthetic camera, encoding."""

import os

from vision.sources.decoders import ENVIRONMENT

for _name, _value in ENVIRONMENT.items():
    os.environ.setdefault(_name, _value)  # what somebody has set counts
