"""The simulated rig: the board's twin, its coils, the plant and the world's clock."""
