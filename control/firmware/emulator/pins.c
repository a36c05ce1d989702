// SPDX-License-Identifier: GPL-3.0-or-later
#include "pins.h"

typedef struct {
	uint16_t port; // address of its PIN register
	uint8_t bit;
} pin_t;

typedef struct {
	pin_t ina, inb, enable, pwm;
} wiring_t;

static const wiring_t WIRING[COILS] = {
	{{PIN_D, 2}, {PIN_D, 4}, {PIN_D, 6}, {PIN_B, 1}}, // D2 D4 D6 D9
	{{PIN_D, 7}, {PIN_B, 0}, {PIN_B, 4}, {PIN_B, 2}}, // D7 D8 D12 D10
	{{PIN_B, 3}, {PIN_D, 5}, {PIN_C, 3}, {PIN_D, 3}}, // D11 D5 A3 D3
};

const int PWM_STEPS[COILS] = {800, 800, 100};

const uint16_t PIN_REGISTERS[] = {
	PIN_B, PIN_B + 1, PIN_B + 2, PIN_C, PIN_C + 1, PIN_C + 2, PIN_D, PIN_D + 1, PIN_D + 2,
	TCCR_1A, TCCR_1B, ICR_1L, OCR_1AL, OCR_1BL, TCCR_2A, TCCR_2B, OCR_2A, OCR_2B, 0,
};

static bool is_output(const avr_t *avr, pin_t pin)
{
	return avr->data[pin.port + 1] >> pin.bit & 1;
}

static bool is_driven_high(const avr_t *avr, pin_t pin)
{
	return is_output(avr, pin) && (avr->data[pin.port + 2] >> pin.bit & 1);
}

static int word(const avr_t *avr, uint16_t low)
{
	return avr->data[low] | avr->data[low + 1] << 8;
}

// A timer's compare output: its mode bits (2 is non-inverting PWM), whether it counts as it should, its registers.
typedef struct {
	int mode;
	bool counts;
	int compare, top;
} output_t;

static output_t output_of_timer_1(const avr_t *avr, int shift, uint16_t compare)
{
	uint8_t a = avr->data[TCCR_1A], b = avr->data[TCCR_1B];
	bool is_fast_pwm_to_icr = (a & 3) == 2 && (b & 0x18) == 0x18;
	return (output_t){a >> shift & 3, is_fast_pwm_to_icr && (b & 7) == 1, word(avr, compare), word(avr, ICR_1L)};
}

static output_t output_of_timer_2(const avr_t *avr)
{
	uint8_t a = avr->data[TCCR_2A], b = avr->data[TCCR_2B];
	bool is_fast_pwm_to_ocra = (a & 3) == 3 && (b & 8) == 8;
	return (output_t){a >> 4 & 3, is_fast_pwm_to_ocra && (b & 7) == 2, avr->data[OCR_2B], avr->data[OCR_2A]};
}

static output_t output_of(const avr_t *avr, int coil)
{
	switch (coil) {
	case 0:
		return output_of_timer_1(avr, 6, OCR_1AL);
	case 1:
		return output_of_timer_1(avr, 4, OCR_1BL);
	default:
		return output_of_timer_2(avr);
	}
}

// Fast PWM is high for compare + 1 of top + 1 counts. Ripple and the buffering of the compare register, 50 us
// each, are left out.
static int steps(const avr_t *avr, int coil)
{
	output_t output = output_of(avr, coil);
	if (!is_output(avr, WIRING[coil].pwm))
		return 0;
	if (output.mode == 0)
		return is_driven_high(avr, WIRING[coil].pwm) ? PWM_STEPS[coil] : 0;
	if (output.mode != 2 || !output.counts || output.compare >= output.top)
		return PWM_STEPS[coil];
	return (output.compare + 1) * PWM_STEPS[coil] / (output.top + 1);
}

static int direction(const avr_t *avr, int coil)
{
	return is_driven_high(avr, WIRING[coil].ina) - is_driven_high(avr, WIRING[coil].inb);
}

int pins_duty(const avr_t *avr, int coil)
{
	return direction(avr, coil) < 0 ? -steps(avr, coil) : steps(avr, coil);
}

bool pins_released(const avr_t *avr, int coil)
{
	return !is_output(avr, WIRING[coil].enable);
}

static bool is_enabled(const avr_t *avr, const coils_t *coils, int coil)
{
	bool is_up = pins_released(avr, coil) || is_driven_high(avr, WIRING[coil].enable);
	return is_up && !coils->coil[coil].has_fault;
}

double pins_drive(const avr_t *avr, const coils_t *coils, int coil)
{
	if (!is_enabled(avr, coils, coil))
		return 0.0;
	return (double)(direction(avr, coil) * steps(avr, coil)) / PWM_STEPS[coil];
}

void pins_show_diagnosis(avr_t *avr, const coils_t *coils)
{
	for (int k = 0; k < COILS; k++) {
		pin_t enable = WIRING[k].enable;
		uint8_t mask = (uint8_t)(1 << enable.bit);
		if (is_enabled(avr, coils, k))
			avr->data[enable.port] |= mask;
		else
			avr->data[enable.port] &= (uint8_t)~mask;
	}
}
