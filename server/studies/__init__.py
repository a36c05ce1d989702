"""Studies in the data folder: what was asked for, what came of it so far, and who carries it out."""
