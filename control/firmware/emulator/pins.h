// How the UNO is wired to the two motor shields: what its registers do to the three bridges.
// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef PIVOT_BOARD_PINS_H
#define PIVOT_BOARD_PINS_H

#include "coils.h"

#include <simavr/sim_avr.h>

// Registers of the ATmega328P, by their data address.
enum {
	PIN_B = 0x23, PIN_C = 0x26, PIN_D = 0x29, // DDR and PORT follow each
	TCCR_1A = 0x80, TCCR_1B = 0x81, ICR_1L = 0x86, OCR_1AL = 0x88, OCR_1BL = 0x8A,
	TCCR_2A = 0xB0, TCCR_2B = 0xB1, OCR_2A = 0xB3, OCR_2B = 0xB4,
	GPIOR_0 = 0x3E, GPIOR_1 = 0x4A, MCUSR_ = 0x54, TIMSK_0 = 0x6E,
};

// PWM steps of each bridge's timer.
extern const int PWM_STEPS[COILS];

// Signed PWM steps as the pins stand. A pin that is stuck high counts as full drive.
int pins_duty(const avr_t *avr, int coil);

// The share of the supply that the bridge puts out: none while its EN/DIAG line is low or it brakes.
double pins_drive(const avr_t *avr, const coils_t *coils, int coil);

// Whether the board lets go of the bridge's EN/DIAG line, so that it rises unless the driver pulls it down.
bool pins_released(const avr_t *avr, int coil);

// What the board reads of the EN/DIAG lines: up by their resistors unless the driver pulls them down.
void pins_show_diagnosis(avr_t *avr, const coils_t *coils);

// The registers whose writing may change a bridge; a list that ends with 0.
extern const uint16_t PIN_REGISTERS[];

#endif
