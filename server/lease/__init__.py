"""Who operates the rig: one at a time, by a lease that lasts while its holder is heard."""
