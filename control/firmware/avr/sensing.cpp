// A round starts half a millisecond before the tick that uses it and takes 0.42 ms: four conversions of 13 cycles of
// 125 kHz, the fastest clock below the 200 kHz up to which the ADC keeps its 10 bits.
#include "sensing.h"

#include <avr/interrupt.h>

#include "registers.h"

namespace pivotrig {
namespace sensing {

namespace {

constexpr uint8_t input_count = 4;
constexpr uint8_t inputs[input_count] = {0, 1, 2, 5};  // A0, A1, A2: coils 1 to 3; A5: supply
constexpr uint8_t reference = bit(REFS0);              // the 5 V supply of the board

uint16_t running[input_count];
uint16_t complete[input_count];
uint8_t current_input;

inline void convert(uint8_t input) {
    ADMUX = static_cast<uint8_t>(reference | inputs[input]);
    set(ADCSRA, ADSC);
}

void start_round() {
    current_input = 0;
    convert(0);
}

void take() {
    running[current_input] = ADC;
    ++current_input;
    if (current_input < input_count) {
        convert(current_input);
        return;
    }
    for (uint8_t input = 0; input < input_count; ++input) {
        complete[input] = running[input];
    }
}

}  // namespace

void begin() {
    DIDR0 = bit(ADC0D) | bit(ADC1D) | bit(ADC2D) | bit(ADC5D);
    ADCSRA = bit(ADEN) | bit(ADIE) | bit(ADPS2) | bit(ADPS1) | bit(ADPS0);
}

void read(Readings& readings) {
    for (uint8_t coil = 0; coil < coil_count; ++coil) {
        readings.currents[coil] = complete[coil];
    }
    readings.supply = complete[coil_count];
}

}  // namespace sensing
}  // namespace pivotrig

ISR(TIMER0_COMPB_vect) { pivotrig::sensing::start_round(); }

ISR(ADC_vect) { pivotrig::sensing::take(); }
