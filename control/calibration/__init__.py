"""What a rig has to be measured for before its coils can be trusted: fields, windings, wiring, place.

`bench` drives the coils for it; the other modules are pure: readings in, figures or a verdict out.
"""
