"""What is measured of a camera: its lens, where the plate lies, and how late its pictures are."""
