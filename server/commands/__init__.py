"""Commands of `pivotrig`, one a file."""
