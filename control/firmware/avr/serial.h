// The UART at 500 kbaud.
#ifndef PIVOTRIG_SERIAL_H
#define PIVOTRIG_SERIAL_H

#include "../portable/frame.h"

namespace pivotrig {
namespace serial {

using Inbox = Ring<128>;

extern Inbox inbox;

// outbox: what the interrupt sends from.
void begin(Outbox& outbox);

// Sends on if there is something to send.
void wake();

// Nothing is sent until the next `wake`; what comes in is still taken.
void pause();

}  // namespace serial
}  // namespace pivotrig

#endif
