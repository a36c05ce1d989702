// The ADC: three current senses and the supply, once a millisecond.
#ifndef PIVOTRIG_SENSING_H
#define PIVOTRIG_SENSING_H

#include "../portable/coil_drive.h"

namespace pivotrig {
namespace sensing {

void begin();

// The last completed round; to be called with interrupts off.
void read(Readings& readings);

}  // namespace sensing
}  // namespace pivotrig

#endif
