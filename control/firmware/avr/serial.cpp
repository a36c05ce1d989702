#include "serial.h"

#include <avr/interrupt.h>

#include "registers.h"

namespace pivotrig {
namespace serial {

Inbox inbox;

namespace {

// 16 MHz / 8 / (3 + 1) = 500 kbaud without any error.
constexpr uint8_t divisor = 3;

Outbox* outgoing;

}  // namespace

void begin(Outbox& outbox) {
    outgoing = &outbox;
    UBRR0 = divisor;
    UCSR0A = bit(U2X0);
    UCSR0C = bit(UCSZ01) | bit(UCSZ00);
    UCSR0B = bit(RXCIE0) | bit(RXEN0) | bit(TXEN0);
}

void wake() {
    if (!outgoing->is_empty()) {
        set(UCSR0B, UDRIE0);
    }
}

void pause() { clear(UCSR0B, UDRIE0); }

// A byte that finds no room is lost, and its message with it: the checksum notices.
inline void receive() {
    const uint8_t byte = UDR0;
    if (inbox.room() != 0) {
        inbox.push(byte);
    }
}

inline void transmit() {
    if (outgoing->is_empty()) {
        clear(UCSR0B, UDRIE0);
    } else {
        UDR0 = outgoing->pop();
    }
}

}  // namespace serial
}  // namespace pivotrig

ISR(USART_RX_vect) { pivotrig::serial::receive(); }

ISR(USART_UDRE_vect) { pivotrig::serial::transmit(); }
