"""`python -m server` is `pivotrig`."""

from server.cli import main

main()
