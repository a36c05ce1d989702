"""A recording, read back; the file is never trusted."""
