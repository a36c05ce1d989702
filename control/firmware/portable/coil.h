// One coil: its share of the field, its limits, its regulator, and what the last millisecond brought.
#ifndef PIVOTRIG_COIL_H
#define PIVOTRIG_COIL_H

#include <stdint.h>

#include "regulator.h"

namespace pivotrig {

// A field, uT.
struct Field {
    int16_t x;
    int16_t y;
    int16_t z;
};

struct Coil {
    Regulator regulator;
    int16_t allocation[3] = {};  // Q14 mA/uT
    int16_t limit = 0;           // mA
    uint16_t half_limit = 0;
    uint16_t trips[2] = {};  // ADC counts at 1.25 times the limit: forward, reverse
    uint16_t counts = 0;     // sensed
    int32_t wanted = 0;      // mA, whatever the limit
    int16_t commanded = 0;   // mA, within the limit
    int16_t duty = 0;        // signed PWM steps

    void rest();

    // Current for a field.
    void want(const Field& field);

    bool is_beyond_limit() const;

    // Whether it is beyond its limit by a larger factor than another one.
    bool is_farther_beyond_than(const Coil& other) const;

    // The limit as a share (Q14) of a current beyond it.
    int16_t share_within_limit() const;

    bool is_over_current() const { return counts > trips[regulator.flows_backwards()]; }

 private:
    uint16_t half_wanted() const;
};

}  // namespace pivotrig

#endif
