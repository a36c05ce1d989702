// From the field that is commanded to the PWM of three bridges. Field in uT, currents in mA, supply in mV.
#ifndef PIVOTRIG_COIL_DRIVE_H
#define PIVOTRIG_COIL_DRIVE_H

#include <stdint.h>

#include "coil.h"
#include "contract.h"
#include "motion.h"

namespace pivotrig {

constexpr uint8_t coil_count = 3;

// What the board senses in one millisecond. currents, supply: ADC counts.
struct Readings {
    uint16_t currents[coil_count];
    uint16_t supply;
    bool driver_fault;
};

class CoilDrive {
 public:
    void configure(const Configure& message);
    void allocate(const Drive& drive);

    // All bridges off.
    void rest();

    void sense(const Readings& readings);

    // One millisecond without drive: the observers follow the currents that decay.
    void coast();

    // Whether a coil has been sensed above 1.25 times its limit for 3 ms; to be asked once a tick.
    bool is_over_current();

    // One millisecond of regulation towards the field of `motion`.
    void advance(const FieldMotion& motion);

    // Signed PWM steps.
    int16_t duty(uint8_t coil) const { return coils_[coil].duty; }

    // Fills in what a report says of the coils, and returns its flags.
    uint16_t describe(Telemetry& report) const;

 private:
    void aim(const FieldMotion& motion);
    const Coil* farthest_beyond_limit() const;
    void scale_back(int16_t share);
    void settle_supply(uint16_t supply);
    void regulate();

    Coil coils_[coil_count];
    Supply fine_ = {};    // for the bridges of 800 steps
    Supply coarse_ = {};  // for the one of 100
    uint16_t nominal_ = 0;
    uint16_t low_supply_ = 0;
    uint16_t scale_ = 0;
    uint16_t supply_ = 0;
    uint16_t settled_supply_ = 0;
    bool is_supply_settled_ = false;
    bool is_supply_low_ = false;
    bool is_saturated_ = false;
    uint8_t over_current_ = 0;
};

}  // namespace pivotrig

#endif
