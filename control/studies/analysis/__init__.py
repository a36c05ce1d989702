"""What a study's table says: pure functions from its rows to frozen results, with intervals."""
