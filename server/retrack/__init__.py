"""Recorded pictures, looked at again: by another tracker, filter or camera model, or for another controller."""
