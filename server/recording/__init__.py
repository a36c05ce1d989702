"""Recordings: one MCAP file a run, written beside the loop and never on it, and read without trust."""
