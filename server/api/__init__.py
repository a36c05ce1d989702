"""One router per resource of the REST and WebSocket interface."""
