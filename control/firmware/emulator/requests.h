// The words of the lock-step port: one request in, its answer out. The protocol is that of
// control/simulation/lockstep.py; `trace`, `cycles` and `enable` are
// this board's own.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_REQUESTS_H
#define PIVOT_BOARD_REQUESTS_H

#include "machine.h"
#include "text.h"

enum { MOST_STEPS = 1000, MOST_SAMPLES = 2000 };

// What a request is to be answered from and may change.
typedef struct {
	machine_t *machine;
	uint64_t *taken;  // this client's last sample, ms
	bool *is_stepped; // set when the board is to stand still between steps
	bool is_running;
} session_t;

void answer(session_t *session, char *request, text_t *reply);

#endif
