"""The outside: FastAPI application, REST, WebSocket, Viser scene, settings and the command line."""

__version__ = "0.1.0"
