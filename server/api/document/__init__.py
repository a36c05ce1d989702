"""The description of the interface: what every answer looks like, for people, for generated clients and for tests."""
