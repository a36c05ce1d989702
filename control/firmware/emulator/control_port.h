// The lock-step port: TCP on loopback, one line of text a request, several clients.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_CONTROL_PORT_H
#define PIVOT_BOARD_CONTROL_PORT_H

#include "machine.h"
#include "text.h"

enum { MOST_CLIENTS = 8, MOST_REQUEST = 256, NOBODY = -1, SOMEBODY_TO_COME = -2 };

typedef struct {
	int socket; // NOBODY: this place is free
	char request[MOST_REQUEST];
	size_t length;
	text_t reply;
	uint64_t taken; // the last sample that this client has had, ms
} client_t;

typedef struct {
	int listener;
	int port;
	client_t client[MOST_CLIENTS];
	int stepper;     // whose steps the board obeys; NOBODY when it runs freely, or it waits for SOMEBODY_TO_COME
	double run_from; // the clock, s, at which the free run has done all that was due
	double left_at;  // when the last client went, s; 0 while there is one, or none has come yet
	bool was_visited;
} control_port_t;

bool control_open(control_port_t *control, int port, double now);
void control_close(control_port_t *control);

// Waits up to `timeout_ms` for requests and answers them, then runs a free board on to `now`.
// `life`, when it is not NOBODY, is watched too: false once its other end is closed.
bool control_serve(control_port_t *control, machine_t *machine, int timeout_ms, int life);

double monotonic(void);

#endif
