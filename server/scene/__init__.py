"""The 3D scene: Viser behind our own door, for the live rig and for replays."""
