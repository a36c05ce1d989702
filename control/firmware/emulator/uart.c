// SPDX-License-Identifier: GPL-3.0-or-later
#include "uart.h"

#include <simavr/sim_avr.h>
#include <string.h>

enum { BYTE_CYCLES = 320 };

static void keep(uart_t *uart, uint8_t byte)
{
	if (uart->count == RECEIVER_ROOM) {
		uart->overruns++;
		return;
	}
	uart->waiting[uart->count++] = byte;
	if (uart->count > uart->deepest)
		uart->deepest = uart->count;
}

// One byte's time has passed on the line.
static avr_cycle_count_t receive(avr_t *avr, avr_cycle_count_t when, void *param)
{
	uart_t *uart = param;
	int byte = serial_take(uart->line);
	uart->unit->cycles_per_byte = BYTE_CYCLES;
	if (byte >= 0 && avr_regbit_get(avr, uart->unit->rxen)) {
		keep(uart, (uint8_t)byte);
		avr_raise_interrupt(avr, &uart->unit->rxc);
	}
	return when + BYTE_CYCLES;
}

// The firmware reads the data register.
static uint8_t on_read(avr_t *avr, avr_io_addr_t address, void *param)
{
	uart_t *uart = param;
	if (uart->count > 0) {
		avr->data[address] = uart->waiting[0];
		memmove(uart->waiting, uart->waiting + 1, --uart->count);
	}
	avr_clear_interrupt(avr, &uart->unit->rxc);
	avr_regbit_clear(avr, uart->unit->rxc.raised);
	if (uart->count > 0)
		avr_raise_interrupt(avr, &uart->unit->rxc);
	return avr->data[address];
}

static void on_sent(avr_irq_t *irq, uint32_t value, void *param)
{
	uart_t *uart = param;
	(void)irq;
	serial_put(uart->line, (uint8_t)value);
	trace_byte(uart->trace, TRACE_SENT, (uint8_t)value);
}

static avr_uart_t *find(const avr_t *avr)
{
	for (avr_io_t *io = avr->io_port; io != NULL; io = io->next)
		if (strcmp(io->kind, "uart") == 0)
			return (avr_uart_t *)io;
	return NULL;
}

bool uart_connect(uart_t *uart, avr_t *avr, serial_line_t *line, trace_t *trace)
{
	uint32_t silent = 0;
	*uart = (uart_t){.unit = find(avr), .line = line, .trace = trace};
	if (uart->unit == NULL)
		return false;
	avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &silent);
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_sent, uart);
	// simavr lets nobody else register for a register that is being read, so its reader is replaced.
	unsigned place = AVR_DATA_TO_IO(uart->unit->r_udr);
	avr->io[place].r.c = on_read;
	avr->io[place].r.param = uart;
	return true;
}

void uart_recover_from_reset(uart_t *uart)
{
	uart->count = 0;
	serial_forget(uart->line);
	avr_cycle_timer_register(uart->unit->io.avr, BYTE_CYCLES, receive, uart);
}
