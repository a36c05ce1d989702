// SPDX-License-Identifier: GPL-3.0-or-later
#include "text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool make_room(text_t *text, size_t more)
{
	size_t due = text->count + more + 1;
	if (due <= text->room)
		return true;
	size_t room = due > MOST_TEXT ? 0 : 2 * due;
	char *data = room > 0 ? realloc(text->data, room) : NULL;
	if (data == NULL)
		return false;
	text->data = data;
	text->room = room;
	return true;
}

void text_add(text_t *text, const char *format, ...)
{
	va_list arguments, again;
	va_start(arguments, format);
	va_copy(again, arguments);
	int more = vsnprintf(NULL, 0, format, arguments);
	if (more < 0 || text->overflowed || !make_room(text, (size_t)more)) {
		text->overflowed = true;
	} else {
		vsnprintf(text->data + text->count, (size_t)more + 1, format, again);
		text->count += (size_t)more;
	}
	va_end(again);
	va_end(arguments);
}

void text_drop(text_t *text, size_t count)
{
	memmove(text->data, text->data + count, text->count - count);
	text->count -= count;
}

void text_free(text_t *text)
{
	free(text->data);
	*text = (text_t){0};
}
