// SPDX-License-Identifier: GPL-3.0-or-later
#include "serial_line.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

enum {
	DELIVERY_TRIES = 100,
	MOST_READABLE = 4000, // a terminal keeps 4095 bytes for its reader
};

bool serial_open(serial_line_t *line)
{
	struct termios raw;
	memset(line, 0, sizeof *line);
	if (openpty(&line->board_end, &line->host_end, line->name, NULL, NULL) != 0)
		return false;
	if (tcgetattr(line->host_end, &raw) != 0)
		return false;
	cfmakeraw(&raw);
	return tcsetattr(line->host_end, TCSANOW, &raw) == 0 && fcntl(line->board_end, F_SETFL, O_NONBLOCK) == 0;
}

void serial_close(serial_line_t *line)
{
	close(line->board_end);
	close(line->host_end);
}

static size_t place(const bytes_t *bytes, size_t offset)
{
	return (bytes->first + offset) % LINE_BUFFER;
}

static void push(bytes_t *bytes, uint8_t byte)
{
	if (bytes->count < LINE_BUFFER)
		bytes->data[place(bytes, bytes->count++)] = byte;
}

static void drop(bytes_t *bytes, size_t count)
{
	bytes->first = place(bytes, count);
	bytes->count -= count;
}

// An empty-handed read is what makes the terminal hand over what is on its way.
static void fill(serial_line_t *line)
{
	uint8_t chunk[LINE_BUFFER];
	ssize_t got;
	do {
		size_t room = LINE_BUFFER - line->inbox.count;
		got = room > 0 ? read(line->board_end, chunk, room) : 0;
		for (ssize_t k = 0; k < got; k++)
			push(&line->inbox, chunk[k]);
	} while (got > 0);
}

static size_t drain_once(serial_line_t *line)
{
	bytes_t *out = &line->outbox;
	size_t straight = LINE_BUFFER - out->first;
	size_t due = out->count < straight ? out->count : straight;
	ssize_t sent = due > 0 ? write(line->board_end, out->data + out->first, due) : 0;
	if (sent <= 0)
		return 0;
	drop(out, (size_t)sent);
	return (size_t)sent;
}

static size_t exchange(serial_line_t *line)
{
	size_t sent, all = 0;
	fill(line);
	while ((sent = drain_once(line)) > 0)
		all += sent;
	return all;
}

void serial_exchange(serial_line_t *line)
{
	exchange(line);
}

static size_t readable(const serial_line_t *line)
{
	int count = 0;
	struct pollfd host = {.fd = line->host_end, .events = POLLIN};
	poll(&host, 1, 0);
	return ioctl(line->host_end, FIONREAD, &count) == 0 && count > 0 ? (size_t)count : 0;
}

void serial_deliver(serial_line_t *line)
{
	const struct timespec moment = {.tv_nsec = 20000};
	size_t before = readable(line);
	size_t due = before + exchange(line);
	for (int k = 0; k < DELIVERY_TRIES && due <= MOST_READABLE && readable(line) < due; k++)
		nanosleep(&moment, NULL);
}

int serial_take(serial_line_t *line)
{
	if (line->inbox.count == 0)
		return -1;
	uint8_t byte = line->inbox.data[line->inbox.first];
	drop(&line->inbox, 1);
	return byte;
}

void serial_put(serial_line_t *line, uint8_t byte)
{
	push(&line->outbox, byte);
}

void serial_forget(serial_line_t *line)
{
	line->inbox.count = 0;
}
