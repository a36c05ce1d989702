"""The program of the board: an Arduino UNO with two dual VNH5019 shields."""
