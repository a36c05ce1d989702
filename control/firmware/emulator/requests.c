// SPDX-License-Identifier: GPL-3.0-or-later
#include "requests.h"

#include "marks.h"
#include "pins.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_WORDS = 5, MOST_DIGITS = 9, QUOTED = 60 };

typedef struct {
	char *word[MOST_WORDS];
	int count;
} words_t;

static words_t split(char *request)
{
	words_t words = {.count = 0};
	char *rest = NULL;
	for (char *word = strtok_r(request, " \t\r", &rest); word != NULL; word = strtok_r(NULL, " \t\r", &rest)) {
		if (words.count == MOST_WORDS)
			return (words_t){.count = 0};
		words.word[words.count++] = word;
	}
	return words;
}

// -1 when the word is no whole number of few digits.
static long number(const char *word)
{
	size_t length = strlen(word);
	if (length == 0 || length > MOST_DIGITS || strspn(word, "0123456789") != length)
		return -1;
	return strtol(word, NULL, 10);
}

static bool says(const words_t *words, const char *first, int count)
{
	return words->count == count && strcmp(words->word[0], first) == 0;
}

static void done(text_t *reply)
{
	text_add(reply, "done\n");
}

// ---- time

static void add_samples(const machine_t *machine, uint64_t after, text_t *reply)
{
	uint64_t oldest = machine->ms > MOST_SAMPLES ? machine->ms - MOST_SAMPLES : 0;
	for (uint64_t ms = (after > oldest ? after : oldest) + 1; ms <= machine->ms; ms++) {
		const sample_t *s = machine_sample(machine, ms);
		text_add(reply, "%llu %.3f %.3f %.3f %d %d %d\n", (unsigned long long)s->ms, s->current[0] * 1e3,
		         s->current[1] * 1e3, s->current[2] * 1e3, s->duty[0], s->duty[1], s->duty[2]);
	}
}

static void take(session_t *session, text_t *reply)
{
	add_samples(session->machine, *session->taken, reply);
	*session->taken = session->machine->ms;
	done(reply);
}

static void step(session_t *session, long count, text_t *reply)
{
	machine_t *machine = session->machine;
	uint64_t before = machine->ms;
	*session->is_stepped = true;
	serial_exchange(&machine->line);
	for (long k = 0; k < count && !machine->has_crashed; k++)
		machine_run(machine);
	serial_deliver(&machine->line);
	add_samples(machine, before, reply);
	*session->taken = machine->ms;
	done(reply);
}

// ---- the board

static void state(const session_t *session, text_t *reply)
{
	const machine_t *machine = session->machine;
	const sample_t *s = machine_sample(machine, machine->ms);
	bool is_zero = s->duty[0] == 0 && s->duty[1] == 0 && s->duty[2] == 0;
	text_add(reply, "{\"time_ms\": %llu, \"firmware\": \"avr\", \"boot_id\": %u, \"mode\": \"%s\", \"state\": \"%s\", ",
	         (unsigned long long)machine->ms, marks_boot_id(machine), session->is_running ? "run" : "step",
	         marks_state(machine));
	text_add(reply, "\"duty\": [%d, %d, %d], \"drive_is_zero\": %s, \"currents_mA\": [%.3f, %.3f, %.3f]}\n", s->duty[0],
	         s->duty[1], s->duty[2], is_zero ? "true" : "false", s->current[0] * 1e3, s->current[1] * 1e3,
	         s->current[2] * 1e3);
}

static void set(machine_t *machine, const char *name, long coil, long value, text_t *reply)
{
	machine_rewire(machine); // what has been until now was under the old condition
	const char *trouble = coils_set(&machine->coils, name, (int)coil, value);
	machine_rewire(machine);
	if (trouble != NULL)
		text_add(reply, "error: '%.*s': %s\n", QUOTED, name, trouble);
	else
		done(reply);
}

static void reset(machine_t *machine, text_t *reply)
{
	serial_exchange(&machine->line);
	machine_reset(machine);
	done(reply);
}

// ---- what the firmware did

static const char *heading(trace_kind_t kind)
{
	return kind == TRACE_CONSUMED ? "rx " : "tx ";
}

static void add_event(const trace_t *trace, size_t k, text_t *reply)
{
	const event_t *event = &trace->event[k];
	const int16_t *v = event->value;
	switch (event->kind) {
	case TRACE_TICK:
		text_add(reply, "tick %d %d %d %d %d\n", v[0], v[1], v[2], v[3], v[4]);
		break;
	case TRACE_DUTY:
		text_add(reply, "duty %d %d %d\n", v[0], v[1], v[2]);
		break;
	case TRACE_RESET:
		text_add(reply, "reset\n");
		break;
	default: // successive bytes of one kind share a line
		if (k == 0 || event[-1].kind != event->kind)
			text_add(reply, "%s", heading(event->kind));
		text_add(reply, "%02x", (uint8_t)v[0]);
		if (k + 1 == trace->count || event[1].kind != event->kind)
			text_add(reply, "\n");
	}
}

static void trace_taken(trace_t *trace, text_t *reply)
{
	for (size_t k = 0; k < trace->count; k++)
		add_event(trace, k, reply);
	if (trace->lost > 0)
		text_add(reply, "lost %zu\n", trace->lost);
	trace->count = trace->lost = 0;
	done(reply);
}

static bool trace(trace_t *trace, const char *what, text_t *reply)
{
	if (strcmp(what, "take") == 0) {
		trace_taken(trace, reply);
		return true;
	}
	if (strcmp(what, "on") != 0 && strcmp(what, "off") != 0)
		return false;
	trace_switch(trace, strcmp(what, "on") == 0);
	done(reply);
	return true;
}

static void add_watch(const char *name, const stopwatch_t *watch, text_t *reply)
{
	double mean = watch->count > 0 ? (double)watch->sum / (double)watch->count : 0.0;
	text_add(reply, "\"%s\": {\"count\": %llu, \"worst\": %llu, \"mean\": %.1f, \"worst_share\": %.4f}, ", name,
	         (unsigned long long)watch->count, (unsigned long long)watch->worst, mean,
	         (double)watch->worst / CYCLES_PER_MS);
}

static void enable_lines(const machine_t *machine, text_t *reply)
{
	for (int k = 0; k < COILS; k++)
		text_add(reply, "%s%s", k == 0 ? "[" : ", ", pins_released(machine->avr, k) ? "true" : "false");
	text_add(reply, "]\n");
}

// Since the last time that somebody asked.
static void cycles(machine_t *machine, text_t *reply)
{
	text_add(reply, "{");
	add_watch("tick", &machine->tick, reply);
	add_watch("interrupt", &machine->interrupt, reply);
	text_add(reply, "\"period\": %d, \"receiver_depth\": %u, \"overruns\": %lu}\n", CYCLES_PER_MS,
	         machine->uart.deepest, machine->uart.overruns);
	machine->tick = machine->interrupt = (stopwatch_t){0};
	machine->uart.deepest = 0;
	machine->uart.overruns = 0;
}

// ---- one request

static bool obey(session_t *session, const words_t *words, text_t *reply)
{
	machine_t *machine = session->machine;
	char *const *word = words->word;
	if (says(words, "step", 2) && 1 <= number(word[1]) && number(word[1]) <= MOST_STEPS)
		step(session, number(word[1]), reply);
	else if (says(words, "run", 1))
		*session->is_stepped = false, done(reply);
	else if (says(words, "take", 1))
		take(session, reply);
	else if (says(words, "state", 1))
		state(session, reply);
	else if (says(words, "set", 3) && number(word[2]) >= 0)
		set(machine, word[1], 0, number(word[2]), reply);
	else if (says(words, "set", 4) && number(word[2]) >= 1 && number(word[3]) >= 0)
		set(machine, word[1], number(word[2]), number(word[3]), reply);
	else if (says(words, "reset", 1))
		reset(machine, reply);
	else if (says(words, "cycles", 1))
		cycles(machine, reply);
	else if (says(words, "enable", 1))
		enable_lines(machine, reply);
	else
		return says(words, "trace", 2) && trace(&machine->trace, word[1], reply);
	return true;
}

void answer(session_t *session, char *request, text_t *reply)
{
	words_t words = split(request);
	if (words.count == 0 || !obey(session, &words, reply))
		text_add(reply, "error: this is none of: step 1..%d, run, take, state, set NAME VALUE, set NAME COIL VALUE, "
		                "reset, cycles, enable, trace on|off|take\n",
		         MOST_STEPS);
}
