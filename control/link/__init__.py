"""The wire: messages to framed bytes, and the port that carries them."""
