"""Studies: many runs from one definition, as a batch or on a rig; no clock, no server in here."""
