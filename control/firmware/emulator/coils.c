// SPDX-License-Identifier: GPL-3.0-or-later
#include "coils.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const double COUNTS_PER_AMPERE = 0.14 / 5.0 * 1024.0; // VNH5019 datasheet
static const double SUPPLY_FULL_SCALE = 55.0;                // V, a divider of 100 k over 10 k before 5 V

static double voltage(const coil_t *coil, double supply)
{
	if (coil->has_fault)
		return 0.0;
	return (coil->is_swapped ? -1.0 : 1.0) * coil->drive * supply;
}

static void coil_run(coil_t *coil, double supply, double seconds)
{
	double settled = voltage(coil, supply) / coil->resistance;
	double decay = exp(-seconds * coil->resistance / coil->inductance);
	coil->current = coil->is_open ? 0.0 : settled + (coil->current - settled) * decay;
}

void coils_run(coils_t *coils, double seconds)
{
	for (int k = 0; k < COILS; k++)
		coil_run(&coils->coil[k], coils->supply, seconds);
}

static unsigned count(double level)
{
	return level < FULL_COUNT ? (unsigned)level : FULL_COUNT;
}

unsigned coil_sense_count(const coil_t *coil)
{
	return count(fabs(coil->current) * coil->sense * COUNTS_PER_AMPERE);
}

unsigned coils_supply_count(const coils_t *coils)
{
	return count(coils->supply / SUPPLY_FULL_SCALE * 1024.0);
}

static void set_supply(coils_t *coils, int coil, long value)
{
	(void)coil;
	coils->supply = (double)value * 1e-3;
}

static void set_fault(coils_t *coils, int coil, long value)
{
	coils->coil[coil].has_fault = value != 0;
}

static void set_sense(coils_t *coils, int coil, long value)
{
	coils->coil[coil].sense = (double)value * 1e-3;
}

static void set_open(coils_t *coils, int coil, long value)
{
	coils->coil[coil].is_open = value != 0;
}

static void set_resistance(coils_t *coils, int coil, long value)
{
	coils->coil[coil].resistance = (double)value * 1e-3;
}

static void set_swapped(coils_t *coils, int coil, long value)
{
	coils->coil[coil].is_swapped = value != 0;
}

typedef struct {
	const char *name;
	bool per_coil;
	long least, most;
	void (*set)(coils_t *coils, int coil, long value);
} condition_t;

// The same names and ranges as in control/simulation/conditions.py.
static const condition_t CONDITIONS[] = {
	{"supply_mV", false, 0, 65000, set_supply},
	{"driver_fault", true, 0, 1, set_fault},
	{"sense_permille", true, 0, 10000, set_sense},
	{"open_coil", true, 0, 1, set_open},
	{"resistance_mohm", true, 100, 100000, set_resistance},
	{"swapped", true, 0, 1, set_swapped},
};

static const condition_t *find(const char *name)
{
	for (size_t k = 0; k < sizeof CONDITIONS / sizeof *CONDITIONS; k++)
		if (strcmp(CONDITIONS[k].name, name) == 0)
			return &CONDITIONS[k];
	return NULL;
}

const char *coils_set(coils_t *coils, const char *name, int coil, long value)
{
	const condition_t *condition = find(name);
	if (condition == NULL)
		return "there is no such condition; there are: supply_mV, driver_fault, sense_permille, "
		       "open_coil, resistance_mohm, swapped";
	if (condition->per_coil && !(1 <= coil && coil <= COILS))
		return "it belongs to one coil, 1, 2 or 3";
	if (!condition->per_coil && coil != 0)
		return "it belongs to the board, not to a coil";
	if (!(condition->least <= value && value <= condition->most))
		return "the value is outside what is allowed";
	condition->set(coils, coil - 1, value);
	return NULL;
}
