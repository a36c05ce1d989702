"""A recording shown again: at any instant, through the same page and the same scene as the rig itself."""
