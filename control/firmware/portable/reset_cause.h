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

// bootloader: Optiboot's major and minor version in a byte each; 0xFFFF where there is none.  flags: what it left in
// register 2. From 4.6 on it hands MCUSR over; the 4.4 of a stock UNO clears the flags and says nothing. Before 7.0 it
// forgets an external reset when its own watchdog ends it, so a watchdog alone may be either.
inline ResetCause reset_cause_handed_over(uint16_t bootloader, uint8_t flags) {
    constexpr uint16_t first_to_tell = 0x0406, first_to_remember = 0x0700, none = 0xFFFF;
    if (bootloader < first_to_tell || bootloader == none) {
        return ResetCause::Unknown;
    }
    const ResetCause cause = reset_cause(flags);
    return cause == ResetCause::Watchdog && bootloader < first_to_remember ? ResetCause::Unknown : cause;
}

}  // namespace pivotrig

#endif
