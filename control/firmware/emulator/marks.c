// SPDX-License-Identifier: GPL-3.0-or-later
#include "marks.h"

#include "pins.h"

#include <simavr/sim_interrupts.h>

enum { TIMER_0_COMPARE = 14 }; // the 1 kHz interrupt

static void start(stopwatch_t *watch, uint64_t time)
{
	watch->begin = time;
	watch->is_running = true;
}

static void stop(stopwatch_t *watch, uint64_t time)
{
	uint64_t took = time - watch->begin;
	if (!watch->is_running)
		return;
	watch->is_running = false;
	watch->count++;
	watch->sum += took;
	watch->worst = took > watch->worst ? took : watch->worst;
}

static int16_t word(const machine_t *machine, uint16_t address)
{
	return (int16_t)(machine->avr->data[address] | machine->avr->data[address + 1] << 8);
}

static void trace_inputs(machine_t *machine)
{
	event_t event = {.kind = TRACE_TICK};
	if (machine->sensed_at == 0)
		return;
	for (uint16_t k = 0; k < 4; k++)
		event.value[k] = word(machine, (uint16_t)(machine->sensed_at + 2 * k));
	event.value[4] = machine->avr->data[machine->sensed_at + 8];
	trace_add(&machine->trace, event);
}

static void trace_outputs(machine_t *machine)
{
	event_t event = {.kind = TRACE_DUTY};
	for (int k = 0; k < COILS; k++)
		event.value[k] = (int16_t)pins_duty(machine->avr, k);
	trace_add(&machine->trace, event);
}

static void on_tick_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	machine_t *machine = param;
	avr->data[address] = value;
	if (value != 0) {
		start(&machine->tick, machine_now(machine));
		trace_inputs(machine);
	} else if (machine->tick.is_running) {
		stop(&machine->tick, machine_now(machine));
		trace_outputs(machine);
	}
}

static void on_byte_mark(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	machine_t *machine = param;
	avr->data[address] = value;
	trace_byte(&machine->trace, TRACE_CONSUMED, value);
}

static void on_interrupt(avr_irq_t *irq, uint32_t value, void *param)
{
	machine_t *machine = param;
	(void)irq;
	if (value != 0)
		start(&machine->interrupt, machine_now(machine));
	else
		stop(&machine->interrupt, machine_now(machine));
}

unsigned marks_boot_id(const machine_t *machine)
{
	return machine->shown_at == 0 ? 0 : (uint16_t)word(machine, machine->shown_at);
}

const char *marks_state(const machine_t *machine)
{
	static const char *const NAMES[REPORTED_STATES] = {"booted", "ready", "driving", "expired", "stopped", "fault"};
	unsigned code = machine->shown_at == 0 ? REPORTED_STATES : machine->avr->data[machine->shown_at + 2];
	return code < REPORTED_STATES ? NAMES[code] : "unknown";
}

void marks_connect(machine_t *machine)
{
	avr_t *avr = machine->avr;
	avr_register_io_write(avr, GPIOR_0, on_tick_mark, machine);
	avr_register_io_write(avr, GPIOR_1, on_byte_mark, machine);
	avr_irq_register_notify(avr_get_interrupt_irq(avr, TIMER_0_COMPARE) + AVR_INT_IRQ_RUNNING, on_interrupt, machine);
}
