"""The simulated camera and what stands in front of it."""
