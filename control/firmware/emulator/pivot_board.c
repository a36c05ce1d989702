// The compiled firmware on an emulated UNO, with coils behind it: a serial port, and a port that governs its time.
//
//     pivot_board --firmware build/firmware/pivotrig.elf --control-port 0
//
// prints one line, `board: serial=/dev/pts/N control=tcp://127.0.0.1:PORT`, and ends some seconds after its last
// client has gone, or on SIGTERM.
//
// Copyright (C) The pivotrig developers
//
// This program is free software: you can redistribute it and/or modify it under the terms of the GNU General
// Public License as published by the Free Software Foundation, either version 3 of the License, or (at your
// option) any later version. It is distributed WITHOUT ANY WARRANTY; see the file LICENSE beside this one.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_port.h"
#include "machine.h"

#include <getopt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PACE_MS = 1, IDLE_MS = 50, EXIT_USAGE = 2 };

static const double PATIENCE = 60.0; // how long to wait for a first client, s

typedef struct {
	const char *firmware;
	int control_port;
	double linger;
	uint16_t boot_id;
	double supply;
	double resistance[COILS], inductance[COILS]; // ohm, mH
	bool is_paused; // until the first request to step or run
	int life;       // a file descriptor whose end is the program's end
} options_t;

static volatile sig_atomic_t is_ending;

static void end(int signal)
{
	(void)signal;
	is_ending = 1;
}

static int usage(void)
{
	fprintf(stderr, "usage: pivot_board --firmware ELF [--control-port N] [--linger S] [--boot-id N] [--supply-V V]\n"
	                "    [--resistance-ohm X Y Z] [--inductance-mH X Y Z] [--end-with-stdin] [--paused]\n");
	return EXIT_USAGE;
}

static bool read_number(const char *text, double least, double most, double *value)
{
	char *rest;
	*value = strtod(text, &rest);
	return rest != text && *rest == '\0' && least <= *value && *value <= most;
}

// Three numbers: the option's and the two words after it.
static bool read_triple(int count, char **arguments, double most, double *values)
{
	if (optind + COILS - 1 > count)
		return false;
	bool is_good = read_number(optarg, 1e-3, most, &values[0]);
	for (int k = 1; k < COILS; k++)
		is_good = read_number(arguments[optind++], 1e-3, most, &values[k]) && is_good;
	return is_good;
}

static bool take_option(options_t *options, int option, int count, char **arguments)
{
	double number = 0.0;
	switch (option) {
	case 'f':
		options->firmware = optarg;
		return true;
	case 'c':
		options->control_port = read_number(optarg, 0, 65535, &number) ? (int)number : NOBODY;
		return options->control_port != NOBODY;
	case 'l':
		return read_number(optarg, 0.0, 1e9, &options->linger);
	case 'b':
		options->boot_id = read_number(optarg, 1, 65535, &number) ? (uint16_t)number : 0;
		return options->boot_id != 0;
	case 's':
		return read_number(optarg, 0.0, 65.0, &options->supply);
	case 'r':
		return read_triple(count, arguments, 100.0, options->resistance);
	case 'i':
		return read_triple(count, arguments, 10000.0, options->inductance);
	case 'p':
		options->is_paused = true;
		return true;
	case 'e':
		options->life = 0;
		return true;
	default:
		return false;
	}
}

static bool read_options(int count, char **arguments, options_t *options)
{
	static const struct option KNOWN[] = {
		{"firmware", required_argument, NULL, 'f'},       {"control-port", required_argument, NULL, 'c'},
		{"linger", required_argument, NULL, 'l'},         {"boot-id", required_argument, NULL, 'b'},
		{"supply-V", required_argument, NULL, 's'},       {"resistance-ohm", required_argument, NULL, 'r'},
		{"inductance-mH", required_argument, NULL, 'i'},  {"end-with-stdin", no_argument, NULL, 'e'},
		{"paused", no_argument, NULL, 'p'},               {NULL, 0, NULL, 0},
	};
	int option;
	while ((option = getopt_long(count, arguments, "", KNOWN, NULL)) != -1)
		if (!take_option(options, option, count, arguments))
			return false;
	return options->firmware != NULL && optind == count;
}

static void lay_coils(coils_t *coils, const options_t *options)
{
	coils->supply = options->supply;
	for (int k = 0; k < COILS; k++)
		coils->coil[k] = (coil_t){
			.resistance = options->resistance[k], .inductance = options->inductance[k] * 1e-3, .sense = 1.0};
}

static bool is_forgotten(const control_port_t *control, double linger, double begin)
{
	double time = monotonic();
	if (control->left_at > 0.0)
		return time - control->left_at > linger;
	return !control->was_visited && time - begin > (linger > PATIENCE ? linger : PATIENCE);
}

static int run(machine_t *machine, control_port_t *control, const options_t *options)
{
	double begin = monotonic();
	while (!is_ending && !machine->has_crashed && !is_forgotten(control, options->linger, begin))
		if (!control_serve(control, machine, control->stepper == NOBODY ? PACE_MS : IDLE_MS, options->life))
			break;
	if (machine->has_crashed)
		fprintf(stderr, "the firmware has crashed: it ran an instruction that there is not, or slept for good\n");
	return machine->has_crashed ? EXIT_FAILURE : EXIT_SUCCESS;
}

int main(int count, char **arguments)
{
	static machine_t machine;
	static control_port_t control;
	options_t options = {.linger = 10.0,
	                     .boot_id = 1,
	                     .supply = 24.0,
	                     .resistance = {2.5, 2.0, 1.5},
	                     .inductance = {125.0, 55.0, 14.0},
	                     .life = NOBODY};
	if (!read_options(count, arguments, &options))
		return usage();
	signal(SIGTERM, end);
	signal(SIGINT, end);
	lay_coils(&machine.coils, &options);
	if (!serial_open(&machine.line) || !control_open(&control, options.control_port, monotonic())) {
		perror("cannot open the serial line or the control port");
		return EXIT_FAILURE;
	}
	if (!machine_load(&machine, options.firmware, options.boot_id))
		return EXIT_FAILURE;
	if (options.is_paused)
		control.stepper = SOMEBODY_TO_COME;
	printf("board: serial=%s control=tcp://127.0.0.1:%d\n", machine.line.name, control.port);
	fflush(stdout);
	int status = run(&machine, &control, &options);
	control_close(&control);
	serial_close(&machine.line);
	return status;
}
