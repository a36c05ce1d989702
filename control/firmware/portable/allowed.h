// Which configurations the board takes.
#ifndef PIVOTRIG_ALLOWED_H
#define PIVOTRIG_ALLOWED_H

#include "contract.h"

namespace pivotrig {

// Within the ranges, and no coil faster than L/R = 5 ms, which a 1 kHz loop could not regulate.
bool is_allowed(const Configure& message);

}  // namespace pivotrig

#endif
