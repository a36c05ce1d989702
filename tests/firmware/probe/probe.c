/* A program for the emulated board that does what the test says: registers are read and written over the UART.
 *
 *     w ADDRESS VALUE   write a register (one byte each)
 *     r ADDRESS         read it; answers its value
 *     h                 hang with interrupts off, so that the watchdog bites
 *     d                 be deaf for 100 byte times
 *
 * It begins by sending the reset flags of the processor. Every millisecond it marks a tick of known length. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <util/delay.h>

struct {
	uint16_t counts[3];
	uint16_t supply;
	uint8_t driver_fault;
} sensed __attribute__((used));

struct {
	uint16_t boot_id;
	uint8_t state;
} shown __attribute__((used)) = {4242, 2};

static uint8_t hear(void)
{
	while (!(UCSR0A & (1 << RXC0)))
		;
	uint8_t byte = UDR0;
	GPIOR1 = byte;
	return byte;
}

static void say(uint8_t byte)
{
	while (!(UCSR0A & (1 << UDRE0)))
		;
	UDR0 = byte;
}

static uint16_t convert(uint8_t input)
{
	ADMUX = (1 << REFS0) | input;
	ADCSRA |= 1 << ADSC;
	while (ADCSRA & (1 << ADSC))
		;
	return ADC;
}

ISR(TIMER0_COMPA_vect)
{
	wdt_reset();
	for (uint8_t k = 0; k < 3; k++)
		sensed.counts[k] = convert(k);
	sensed.supply = convert(5);
	GPIOR0 = 1;
	_delay_us(20);
	GPIOR0 = 0;
}

static void obey(uint8_t order)
{
	if (order == 'w') {
		uint8_t address = hear();
		*(volatile uint8_t *)(uint16_t)address = hear();
	} else if (order == 'r') {
		say(*(volatile uint8_t *)(uint16_t)hear());
	} else if (order == 'd') {
		cli();
		_delay_us(2000);
		sei();
	} else if (order == 'h') {
		cli();
		for (;;)
			;
	}
}

int main(void)
{
	uint8_t flags = MCUSR;
	MCUSR = 0;
	wdt_disable();
	UCSR0A = 1 << U2X0;
	UBRR0 = 3;
	UCSR0B = (1 << RXEN0) | (1 << TXEN0);
	ADCSRA = (1 << ADEN) | (1 << ADPS2);
	TCCR0A = 1 << WGM01;
	OCR0A = 249;
	TCCR0B = (1 << CS01) | (1 << CS00);
	TIMSK0 = 1 << OCIE0A;
	wdt_enable(WDTO_250MS);
	sei();
	say(flags);
	for (;;)
		obey(hear());
}
