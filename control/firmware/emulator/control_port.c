// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_port.h"

#include "requests.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { MOST_CATCH_UP = 1000, MOST_UNREAD = 1 << 18 };

double monotonic(void)
{
	struct timespec time;
	clock_gettime(CLOCK_MONOTONIC, &time);
	return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

bool control_open(control_port_t *control, int port, double now)
{
	struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
	socklen_t size = sizeof address;
	int yes = 1;
	memset(control, 0, sizeof *control);
	address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
	for (int k = 0; k < MOST_CLIENTS; k++)
		control->client[k].socket = NOBODY;
	control->stepper = NOBODY;
	control->run_from = now;
	control->listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
	setsockopt(control->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
	if (bind(control->listener, (struct sockaddr *)&address, size) != 0 || listen(control->listener, 8) != 0)
		return false;
	getsockname(control->listener, (struct sockaddr *)&address, &size);
	control->port = ntohs(address.sin_port);
	return true;
}

// ---- clients

static bool is_anybody_here(const control_port_t *control)
{
	for (int k = 0; k < MOST_CLIENTS; k++)
		if (control->client[k].socket != NOBODY)
			return true;
	return false;
}

static void release(control_port_t *control)
{
	control->stepper = NOBODY;
	control->run_from = monotonic();
}

// When the client that stepped goes away the board runs freely again, so that its dead-man acts.
static void dismiss(control_port_t *control, int k)
{
	client_t *client = &control->client[k];
	close(client->socket);
	text_free(&client->reply);
	*client = (client_t){.socket = NOBODY};
	if (control->stepper == k)
		release(control);
	if (!is_anybody_here(control))
		control->left_at = monotonic();
}

static int free_place(const control_port_t *control)
{
	for (int k = 0; k < MOST_CLIENTS; k++)
		if (control->client[k].socket == NOBODY)
			return k;
	return NOBODY;
}

static void welcome(control_port_t *control, uint64_t ms)
{
	int yes = 1;
	int socket = accept4(control->listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
	int place = free_place(control);
	if (socket < 0)
		return;
	if (place == NOBODY) {
		close(socket);
		return;
	}
	setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
	control->client[place] = (client_t){.socket = socket, .taken = ms};
	control->left_at = 0.0;
	control->was_visited = true;
}

// ---- requests

static void answer_one(control_port_t *control, machine_t *machine, int k, char *request)
{
	client_t *client = &control->client[k];
	bool was_stepped = control->stepper != NOBODY;
	bool is_stepped = was_stepped;
	session_t session = {machine, &client->taken, &is_stepped, !was_stepped};
	uint64_t before = machine->ms;
	answer(&session, request, &client->reply);
	if (was_stepped && !is_stepped)
		release(control);
	else if (machine->ms != before)
		control->stepper = k; // who steps last
}

static void answer_all(control_port_t *control, machine_t *machine, int k)
{
	client_t *client = &control->client[k];
	char *begin = client->request, *end;
	char *limit = client->request + client->length;
	while ((end = memchr(begin, '\n', (size_t)(limit - begin))) != NULL) {
		*end = '\0';
		answer_one(control, machine, k, begin);
		begin = end + 1;
	}
	client->length = (size_t)(limit - begin);
	memmove(client->request, begin, client->length);
}

// False when the client is gone, or says more in one request than any takes.
static bool hear(control_port_t *control, machine_t *machine, int k)
{
	client_t *client = &control->client[k];
	ssize_t got = recv(client->socket, client->request + client->length, MOST_REQUEST - client->length, 0);
	if (got < 0)
		return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
	if (got == 0)
		return false;
	client->length += (size_t)got;
	answer_all(control, machine, k);
	return client->length < MOST_REQUEST;
}

// False when the client is gone, or has left too much unread.
static bool flush(client_t *client)
{
	while (client->reply.count > 0) {
		ssize_t sent = send(client->socket, client->reply.data, client->reply.count, MSG_NOSIGNAL);
		if (sent < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
			return false;
		if (sent <= 0)
			break;
		text_drop(&client->reply, (size_t)sent);
	}
	return !client->reply.overflowed;
}

static bool attend(control_port_t *control, machine_t *machine, int k, short events)
{
	client_t *client = &control->client[k];
	bool is_patient = client->reply.count < MOST_UNREAD;
	if ((events & (POLLIN | POLLHUP | POLLERR)) != 0 && is_patient && !hear(control, machine, k))
		return (void)flush(client), false;
	return flush(client);
}

// ---- the free run

static void run_freely(control_port_t *control, machine_t *machine)
{
	double now = monotonic();
	long due = (long)((now - control->run_from) * 1e3);
	if (due > MOST_CATCH_UP) {
		control->run_from += (double)(due - MOST_CATCH_UP) * 1e-3;
		due = MOST_CATCH_UP;
	}
	control->run_from += (double)due * 1e-3;
	serial_exchange(&machine->line);
	for (; due > 0 && !machine->has_crashed; due--)
		machine_run(machine);
	serial_exchange(&machine->line);
}

bool control_serve(control_port_t *control, machine_t *machine, int timeout_ms, int life)
{
	struct pollfd watched[MOST_CLIENTS + 2];
	for (int k = 0; k < MOST_CLIENTS; k++) {
		const client_t *client = &control->client[k];
		short writing = client->reply.count > 0 ? POLLOUT : 0;
		short reading = client->reply.count < MOST_UNREAD ? POLLIN : 0;
		watched[k] = (struct pollfd){.fd = client->socket, .events = (short)(reading | writing)};
	}
	watched[MOST_CLIENTS] = (struct pollfd){.fd = control->listener, .events = POLLIN};
	watched[MOST_CLIENTS + 1] = (struct pollfd){.fd = life, .events = POLLIN};
	if (poll(watched, MOST_CLIENTS + 2, timeout_ms) > 0) {
		for (int k = 0; k < MOST_CLIENTS; k++)
			if (watched[k].revents != 0 && !attend(control, machine, k, watched[k].revents))
				dismiss(control, k);
		if (watched[MOST_CLIENTS].revents != 0)
			welcome(control, machine->ms);
	}
	if (control->stepper == NOBODY)
		run_freely(control, machine);
	return (watched[MOST_CLIENTS + 1].revents & (POLLHUP | POLLERR | POLLNVAL)) == 0;
}

void control_close(control_port_t *control)
{
	for (int k = 0; k < MOST_CLIENTS; k++)
		if (control->client[k].socket != NOBODY)
			dismiss(control, k);
	close(control->listener);
}
