"""The list of all runs: what can be searched, counted and edited without opening a recording."""
