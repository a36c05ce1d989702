"""Faults that a simulated rig can be given, at its seams: the catalogue, and what is injected now."""
