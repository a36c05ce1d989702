"""The rigid robot: a free body under gravity, Coulomb contact and the torque m x B; nothing kinematic in it."""
