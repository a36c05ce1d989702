"""The science and the real-time path: model, gait, controllers, estimator, coils, link, loop, simulation.

Everything in this package is in SI units (m, rad, s, A, T) and knows nothing of pixels or web servers.
"""
