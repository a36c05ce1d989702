// The board's UART between the serial line and the firmware, at 500 kbaud and 10 bits a byte.
// simavr's own takes 11 bits a byte and buffers 64; a real receiver holds three bytes, and loses the next when the
// firmware is late, so the receiver is made here.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_UART_H
#define PIVOT_BOARD_UART_H

#include "serial_line.h"
#include "trace.h"

#include <simavr/avr_uart.h>

enum { RECEIVER_ROOM = 3 }; // two bytes of buffer and the shift register

typedef struct {
	avr_uart_t *unit;
	serial_line_t *line;
	trace_t *trace;
	uint8_t waiting[RECEIVER_ROOM];
	unsigned count;
	unsigned deepest; // bytes that waited at once
	unsigned long overruns;
} uart_t;

bool uart_connect(uart_t *uart, avr_t *avr, serial_line_t *line, trace_t *trace);
void uart_recover_from_reset(uart_t *uart);

#endif
