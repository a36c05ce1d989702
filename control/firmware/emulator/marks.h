// What the firmware tells an emulator: where a tick begins and ends, which byte it takes, who and how it is.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_MARKS_H
#define PIVOT_BOARD_MARKS_H

#include "machine.h"

void marks_connect(machine_t *machine);

unsigned marks_boot_id(const machine_t *machine);
const char *marks_state(const machine_t *machine);

#endif
