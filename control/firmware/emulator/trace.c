// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace.h"

#include <stdlib.h>

void trace_switch(trace_t *trace, bool on)
{
	if (trace->event == NULL)
		trace->event = malloc(TRACE_ROOM * sizeof *trace->event);
	trace->is_on = on && trace->event != NULL;
	trace->count = trace->lost = 0;
}

void trace_add(trace_t *trace, event_t event)
{
	if (!trace->is_on)
		return;
	if (trace->count < TRACE_ROOM)
		trace->event[trace->count++] = event;
	else
		trace->lost++;
}

void trace_byte(trace_t *trace, trace_kind_t kind, uint8_t byte)
{
	trace_add(trace, (event_t){.kind = kind, .value = {byte}});
}
