// SPDX-License-Identifier: GPL-3.0-or-later
#include "machine.h"

#include "marks.h"
#include "pins.h"

#include <simavr/avr_adc.h>
#include <simavr/avr_eeprom.h>
#include <simavr/avr_extint.h>
#include <simavr/sim_elf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
	FREQUENCY = 16000000,
	SUPPLY_MV = 5000,
	SUPPLY_CHANNEL = 5,
	POWER_ON = 1, EXTERNAL = 2, // reset causes in MCUSR
};

static machine_t *the_machine; // simavr hands no pointer to a reset

// ---- time and the coils

uint64_t machine_now(const machine_t *machine)
{
	return machine->base + machine->avr->cycle;
}

static void settle(machine_t *machine)
{
	uint64_t time = machine_now(machine);
	coils_run(&machine->coils, (double)(time - machine->settled_at) / FREQUENCY);
	machine->settled_at = time;
}

void machine_rewire(machine_t *machine)
{
	settle(machine);
	for (int k = 0; k < COILS; k++)
		machine->coils.coil[k].drive = pins_drive(machine->avr, &machine->coils, k);
	pins_show_diagnosis(machine->avr, &machine->coils);
}

static void on_pin_register(avr_irq_t *irq, uint32_t value, void *machine)
{
	(void)irq, (void)value;
	machine_rewire(machine);
}

// ---- ADC

// simavr takes mV and multiplies by 1023 / 5000, rounding down.
static uint32_t millivolt(unsigned count)
{
	return (count * SUPPLY_MV + 1022) / 1023;
}

static void on_conversion(avr_irq_t *irq, uint32_t value, void *param)
{
	machine_t *machine = param;
	(void)irq, (void)value;
	settle(machine);
	avr_irq_t *input = avr_io_getirq(machine->avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0);
	for (int k = 0; k < COILS; k++)
		avr_raise_irq(input + k, millivolt(coil_sense_count(&machine->coils.coil[k])));
	avr_raise_irq(input + SUPPLY_CHANNEL, millivolt(coils_supply_count(&machine->coils)));
}

// ---- interrupts

// simavr forgets an interrupt that falls due while it is masked; the processor serves it when the mask is lifted.
static void on_timer_mask(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	(void)param;
	avr->data[address] = value;
	for (int k = 0; k < avr->interrupts.vector_count; k++) {
		avr_int_vector_t *vector = avr->interrupts.vector[k];
		if (vector->enable.reg == address && avr_regbit_get(avr, vector->enable) && avr_regbit_get(avr, vector->raised))
			avr_raise_interrupt(avr, vector);
	}
}

// ---- running

static avr_cycle_count_t end_of_stretch(avr_t *avr, avr_cycle_count_t when, void *param)
{
	(void)avr, (void)when, (void)param;
	return 0; // being due is all: the emulator returns at each timer
}

static void note_reset(avr_t *avr)
{
	if (the_machine->reset_hook != NULL)
		the_machine->reset_hook(avr);
	the_machine->was_reset = true;
}

static void sleep_without_waiting(avr_t *avr, avr_cycle_count_t cycles)
{
	(void)avr, (void)cycles;
}

// A reset takes the emulator's timers and inputs with it. Polling of the external interrupts' level, which the
// firmware does not use, would cost nine tenths of the speed.
static void recover_from_reset(machine_t *machine, uint64_t time)
{
	avr_t *avr = machine->avr;
	machine->was_reset = false;
	machine->base = time - avr->cycle;
	avr_extint_set_strict_lvl_trig(avr, 0, 0);
	avr_extint_set_strict_lvl_trig(avr, 1, 0);
	machine->tick.is_running = machine->interrupt.is_running = false;
	uart_recover_from_reset(&machine->uart);
	machine_rewire(machine);
	trace_add(&machine->trace, (event_t){.kind = TRACE_RESET});
}

static void take_sample(machine_t *machine)
{
	sample_t *sample = &machine->sample[++machine->ms % SAMPLES];
	sample->ms = machine->ms;
	for (int k = 0; k < COILS; k++) {
		sample->current[k] = machine->coils.coil[k].current;
		sample->duty[k] = pins_duty(machine->avr, k);
	}
}

const sample_t *machine_sample(const machine_t *machine, uint64_t ms)
{
	return &machine->sample[ms % SAMPLES];
}

static void run_until(machine_t *machine, uint64_t end)
{
	avr_cycle_timer_register(machine->avr, end - machine_now(machine), end_of_stretch, machine);
	while (!machine->was_reset && machine_now(machine) < end && !machine->has_crashed) {
		uint64_t before = machine_now(machine);
		int state = avr_run(machine->avr);
		machine->has_crashed = state == cpu_Done || state == cpu_Crashed;
		if (machine->was_reset)
			recover_from_reset(machine, before);
	}
}

void machine_run(machine_t *machine)
{
	uint64_t end = (machine->ms + 1) * CYCLES_PER_MS;
	while (machine_now(machine) < end && !machine->has_crashed)
		run_until(machine, end);
	settle(machine);
	take_sample(machine);
}

static void reset(machine_t *machine, uint8_t cause)
{
	uint64_t time = machine_now(machine);
	avr_reset(machine->avr);
	recover_from_reset(machine, time);
	machine->avr->data[MCUSR_] = cause;
}

void machine_reset(machine_t *machine)
{
	reset(machine, EXTERNAL);
}

// ---- loading

static void log_errors(avr_t *avr, const int level, const char *format, va_list arguments)
{
	(void)avr;
	if (level <= LOG_ERROR)
		vfprintf(stderr, format, arguments);
}

static uint16_t address_of(const elf_firmware_t *firmware, const char *name)
{
	for (uint32_t k = 0; k < firmware->symbolcount; k++)
		if (strcmp(firmware->symbol[k]->symbol, name) == 0)
			return (uint16_t)firmware->symbol[k]->addr;
	return 0;
}

static void connect(machine_t *machine)
{
	avr_t *avr = machine->avr;
	avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), on_conversion, machine);
	for (const uint16_t *address = PIN_REGISTERS; *address != 0; address++)
		avr_irq_register_notify(avr_iomem_getirq(avr, *address, NULL, AVR_IOMEM_IRQ_ALL), on_pin_register, machine);
	marks_connect(machine);
	avr_register_io_write(avr, TIMSK_0, on_timer_mask, machine);
}

static bool make_avr(machine_t *machine)
{
	avr_t *avr = avr_make_mcu_by_name("atmega328p");
	if (avr == NULL || avr_init(avr) != 0)
		return false;
	avr->frequency = FREQUENCY;
	avr->vcc = avr->avcc = avr->aref = SUPPLY_MV;
	avr->sleep = sleep_without_waiting;
	machine->avr = avr;
	machine->reset_hook = avr->reset;
	the_machine = machine;
	avr->reset = note_reset;
	return uart_connect(&machine->uart, avr, &machine->line, &machine->trace);
}

// The EEPROM as the boot before has left it: control/firmware/portable/boot_count.h; empty before the first boot.
static void remember_boot(machine_t *machine, uint16_t boot_id)
{
	uint16_t last = (uint16_t)(boot_id - 1);
	uint8_t record[] = {(uint8_t)last, (uint8_t)(last >> 8), (uint8_t)~last, (uint8_t)(~last >> 8)};
	avr_eeprom_desc_t content = {.ee = record, .offset = 0, .size = sizeof record};
	if (boot_id > 1)
		avr_ioctl(machine->avr, AVR_IOCTL_EEPROM_SET, &content);
}

bool machine_load(machine_t *machine, const char *elf, uint16_t boot_id)
{
	elf_firmware_t firmware;
	memset(&firmware, 0, sizeof firmware);
	avr_global_logger_set(log_errors);
	if (elf_read_firmware(elf, &firmware) != 0) {
		fprintf(stderr, "cannot read the firmware %s: it must be an ELF file for the ATmega328P\n", elf);
		return false;
	}
	firmware.frequency = FREQUENCY;
	if (!make_avr(machine)) {
		fprintf(stderr, "this simavr knows no ATmega328P with a UART\n");
		return false;
	}
	avr_load_firmware(machine->avr, &firmware);
	machine->sensed_at = address_of(&firmware, "sensed");
	machine->shown_at = address_of(&firmware, "shown");
	connect(machine);
	remember_boot(machine, boot_id);
	reset(machine, POWER_ON);
	return true;
}
