// What the firmware did, in order: bytes that its decoder consumed, ticks with their inputs, bytes that it sent.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_TRACE_H
#define PIVOT_BOARD_TRACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TRACE_ROOM = 1 << 19 }; // events; about half a minute of a busy line

typedef enum { TRACE_CONSUMED, TRACE_SENT, TRACE_TICK, TRACE_DUTY, TRACE_RESET } trace_kind_t;

typedef struct {
	trace_kind_t kind;
	int16_t value[5];
} event_t;

typedef struct {
	bool is_on;
	event_t *event;
	size_t count;
	size_t lost;
} trace_t;

void trace_switch(trace_t *trace, bool on); // forgets what there was
void trace_byte(trace_t *trace, trace_kind_t kind, uint8_t byte);
void trace_add(trace_t *trace, event_t event);

#endif
