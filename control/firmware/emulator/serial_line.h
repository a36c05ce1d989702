// The host's end of the board's UART: a raw pseudo-terminal with bounded buffers.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_SERIAL_LINE_H
#define PIVOT_BOARD_SERIAL_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LINE_BUFFER = 4096 }; // bytes each way, as an operating system keeps them

typedef struct {
	uint8_t data[LINE_BUFFER];
	size_t first, count;
} bytes_t;

typedef struct {
	int board_end, host_end; // the host's end stays open here too, so that the port outlives its host
	char name[128];
	bytes_t inbox, outbox; // towards the board, towards the host
} serial_line_t;

bool serial_open(serial_line_t *line);
void serial_close(serial_line_t *line);

// Carries the bytes that wait at the terminal, either way; never waits.
void serial_exchange(serial_line_t *line);

// The same, and waits until the host can read what has been sent: a terminal hands bytes on in its own time, and
// a board that is stepped must give the same bytes at the same step each time. Gives up after some milliseconds.
void serial_deliver(serial_line_t *line);

// The board's side. `serial_take` is -1 when nothing waits; a byte that finds no room is lost.
int serial_take(serial_line_t *line);
void serial_put(serial_line_t *line, uint8_t byte);

// What was on its way to the board is lost, as in a reset.
void serial_forget(serial_line_t *line);

#endif
