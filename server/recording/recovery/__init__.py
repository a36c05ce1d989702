"""What a program that died has left is mended."""
