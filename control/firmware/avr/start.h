// What happened before `main`: why the processor has started, and how often.
#ifndef PIVOTRIG_START_H
#define PIVOTRIG_START_H

#include <stdint.h>

#include "../portable/contract.h"

namespace pivotrig {
namespace start {

ResetCause cause();

// The id of this boot, which is written to the EEPROM.
uint16_t count_boot();

}  // namespace start
}  // namespace pivotrig

#endif
