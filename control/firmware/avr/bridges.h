// The three VNH5019 bridges on timers 1 and 2.
#ifndef PIVOTRIG_BRIDGES_H
#define PIVOTRIG_BRIDGES_H

#include <stdint.h>

#include "../portable/coil_drive.h"

namespace pivotrig {
namespace bridges {

// Pins and timers, with every bridge off and its enable line held low.
void begin();

// Drives: enable lines released, signed PWM steps on the bridges.
void drive(const CoilDrive& coils);

// PWM low at once. An enable line follows once its coil's current has died away, as `settle` sees it.
void zero();

// One millisecond without drive, with what the current senses read.
void settle(const uint16_t* counts);

// Whether a driver pulls its enable line low although it has been released for a tick or longer.
bool has_driver_fault();

}  // namespace bridges
}  // namespace pivotrig

#endif
