// Text that grows, up to a bound.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_TEXT_H
#define PIVOT_BOARD_TEXT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
	char *data;
	size_t count, room;
	bool overflowed; // more was added than `MOST_TEXT`, or than there is memory; the rest is left out
} text_t;

enum { MOST_TEXT = 1 << 23 };

__attribute__((format(printf, 2, 3))) void text_add(text_t *text, const char *format, ...);
void text_drop(text_t *text, size_t count); // from its beginning
void text_free(text_t *text);

#endif
