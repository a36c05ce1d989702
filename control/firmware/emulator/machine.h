// The board: an emulated ATmega328P that runs the firmware, wired to the coils and to its serial line.
// Pins, timers and the firmware's marks (GPIOR0, GPIOR1, `sensed`, `shown`) are those of control/firmware/README.md.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_MACHINE_H
#define PIVOT_BOARD_MACHINE_H

#include "coils.h"
#include "serial_line.h"
#include "trace.h"
#include "uart.h"

#include <simavr/sim_avr.h>

enum { SAMPLES = 2048, CYCLES_PER_MS = 16000, REPORTED_STATES = 6 };

// The board at the end of one of its milliseconds.
typedef struct {
	uint64_t ms;
	double current[COILS]; // A
	int duty[COILS];       // signed PWM steps, of 800, 800 and 100
} sample_t;

// Cycles of one kind of stretch.
typedef struct {
	uint64_t count, sum, worst, begin;
	bool is_running;
} stopwatch_t;

typedef struct {
	avr_t *avr;
	uart_t uart;
	coils_t coils;
	serial_line_t line;
	trace_t trace;

	uint64_t base;       // cycles before the emulator's present count
	uint64_t settled_at; // up to where the coils have been run
	uint64_t ms;         // milliseconds since the program began; a reset of the board does not start them anew
	sample_t sample[SAMPLES];

	stopwatch_t tick;      // between the firmware's marks
	stopwatch_t interrupt; // of the timer's interrupt, whole

	uint16_t sensed_at, shown_at; // addresses of the firmware's marks; 0 where it has none
	void (*reset_hook)(avr_t *avr);
	bool was_reset;
	bool has_crashed;
} machine_t;

// The first boot gets `boot_id`. False, with a word on stderr, when the ELF file cannot be run. The coils and the line
// are to be set up before.
bool machine_load(machine_t *machine, const char *elf, uint16_t boot_id);

// Runs one millisecond; `machine_sample` then gives its end.
void machine_run(machine_t *machine);
const sample_t *machine_sample(const machine_t *machine, uint64_t ms);

// Presses the reset button.
void machine_reset(machine_t *machine);

// To be called when a condition of the coils has been changed.
void machine_rewire(machine_t *machine);

// Cycles since the program began.
uint64_t machine_now(const machine_t *machine);

#endif
