// Why the processor has started, from the flags that it keeps.
#ifndef PIVOTRIG_RESET_CAUSE_H
#define PIVOTRIG_RESET_CAUSE_H

#include "contract.h"

namespace pivotrig {

// flags: MCUSR as the processor left it, or as a bootloader hands it over; 0 where neither is known.
// A power-on sets the brown-out and external flags as well, and a bootloader ends an external reset with its own
// watchdog, so the first in this order is the cause.
inline ResetCause reset_cause(uint8_t flags) {
    constexpr uint8_t power_on = 1, external = 2, brown_out = 4, watchdog = 8;
    if (flags & power_on) {
        return ResetCause::PowerOn;
    }
    if (flags & brown_out) {
        return ResetCause::BrownOut;
    }
    if (flags & external) {
        return ResetCause::External;
    }
    return flags & watchdog ? ResetCause::Watchdog : ResetCause::Unknown;
}

}  // namespace pivotrig

#endif
