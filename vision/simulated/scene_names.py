"""Names of the scenes, known without OpenCV, which takes a while to load."""

FOR_ANY_LENS = (
    "clean",
    "dim",
    "warm",
    "shadow",
    "glare",
    "exposure_steps",
    "flicker",
    "motion_blur",
    "debris",
    "second_robot",
    "larger_twin",
    "standing_twins",
    "hand",
    "twin_and_hand",
    "larger_twin_and_hand",
    "jpeg",
    "end_mark",
    "dark_plate",
    "blue_on_wood",
    "green_on_white",
    "white_on_slate",
    "everything",
)
"""Scenes of `vision.simulated.scenes` that are not about the lens, and may be played in front of any camera model."""
