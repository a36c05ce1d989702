// The current regulator of one coil at 1 kHz: an observer for the unsigned, coarse current sense, feed-forward plus PI,
// and error feedback for the PWM step that remains. Currents in mA, voltages in mV, unless a comment says otherwise.
#ifndef PIVOTRIG_REGULATOR_H
#define PIVOTRIG_REGULATOR_H

#include <stdint.h>

#include "contract.h"

namespace pivotrig {

// A supply as the regulator of one PWM resolution uses it.
struct Supply {
    int32_t limit;       // mV that may be asked for
    int32_t volts;       // mV of one step, Q8
    int16_t reciprocal;  // steps for 1 mV, Q16
};

class Regulator {
 public:
    // mOhm, 10 uH.
    void configure(uint16_t resistance, uint16_t inductance);

    // For positive and for negative current, Q8 mA per count.
    void sense_with(uint16_t forward, uint16_t reverse);

    // Bridge off: forget target, integral and remainder, but not the current that still flows.
    void rest();

    bool flows_backwards() const { return current_ < 0; }

    // A reading as a current with the observer's sign, within 16 bits.
    int16_t sensed(uint16_t counts) const;

    // One millisecond of the coil's model, then half of the way into the sensed interval.
    void observe(uint16_t counts);

    // Signed PWM steps for the next millisecond.
    int16_t regulate(int16_t target, const Supply& supply);

 private:
    int32_t voltage_for(int16_t target, int32_t product) const;

    int32_t current_ = 0;   // Q8
    int32_t voltage_ = 0;   // that the last steps stand for
    int32_t integral_ = 0;  // Q10 mV
    int16_t target_ = 0;
    uint8_t dither_ = 0;      // steps, Q8
    int16_t feed_ = 0;        // resistance, Q10 mV per mA
    int16_t model_ = 0;       // 1 ms / (L + R * 0.5 ms), Q16 mA per mV
    int16_t gain_ = 0;        // L / 5 ms, Q8 mV per mA, for currents in Q2
    int16_t lead_ = 0;        // L / 1 ms, Q6 mV per mA
    uint16_t gains_[2] = {sense_gain, sense_gain};  // forward, reverse
};

}  // namespace pivotrig

#endif
