"""Section 6 of the paper: its studies as batches, and each of its statements beside what they say."""
