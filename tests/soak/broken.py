"""What ends a soak."""


class InvariantBroken(AssertionError):
    """What must always hold does not; the text begins with the invariant's number where it has one."""
