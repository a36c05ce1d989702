"""Pixels to pose: camera sources, calibration, detection, tracking, the synthetic camera, encoding."""

import cv2

from vision.sources.decoders import quieten

quieten()
# The pictures are small: sharing their rows among threads costs more than it saves.
cv2.setNumThreads(1)
