"""What the program writes for people: the paper's results, ours beside them."""
