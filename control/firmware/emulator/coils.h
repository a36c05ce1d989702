// The electrical world behind the board: a supply, three H-bridges and the coil pairs that they drive.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_COILS_H
#define PIVOT_BOARD_COILS_H

#include <stdbool.h>

enum { COILS = 3, FULL_COUNT = 1023 };

typedef struct {
	double resistance; // ohm
	double inductance; // H
	double current;    // A, positive towards the field's positive axis
	double drive;      // share of the supply that the bridge puts out on average, -1..1
	double sense;      // what the current sense shows for one ampere, 1 when it is true
	bool is_open;
	bool is_swapped;
	bool has_fault;
} coil_t;

typedef struct {
	coil_t coil[COILS];
	double supply; // V
} coils_t;

// Lets `seconds` pass with the drive as it is: the exact solution of L di/dt + R i = v.
void coils_run(coils_t *coils, double seconds);

// What a 10-bit ADC makes of the unsigned current sense (0.14 V/A of 5 V), and of the supply divider.
unsigned coil_sense_count(const coil_t *coil);
unsigned coils_supply_count(const coils_t *coils);

// Makes a named condition hold; `coil` counts from 1, 0 is none. NULL, or what is wrong with it.
const char *coils_set(coils_t *coils, const char *name, int coil, long value);

#endif
