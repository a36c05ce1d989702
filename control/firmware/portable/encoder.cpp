#include "frame.h"

namespace pivotrig {

namespace {

// How far the next zero is from `start`, or the end.
uint8_t run_length(const uint8_t* data, uint8_t start, uint8_t size) {
    uint8_t place = start;
    while (place < size && data[place] != 0) {
        ++place;
    }
    return static_cast<uint8_t>(place - start);
}

// A frame is shorter than the 254 bytes of COBS's longest run, so each run but the last one ends at a zero.
void push_encoded(Outbox& outbox, const uint8_t* data, uint8_t size) {
    uint8_t place = 0;
    while (place <= size) {
        const uint8_t run = run_length(data, place, size);
        outbox.push(static_cast<uint8_t>(run + 1));
        for (const uint8_t end = static_cast<uint8_t>(place + run); place < end; ++place) {
            outbox.push(data[place]);
        }
        ++place;
    }
}

}  // namespace

void send(Outbox& outbox, const Header& header, const void* body, uint8_t body_size) {
    constexpr uint8_t framing = 3;  // a delimiter on each side and the first code byte
    uint8_t data[longest_frame];
    uint8_t size = static_cast<uint8_t>(sizeof header + body_size);
    if (outbox.room() < size + checksum_length + framing) {
        return;
    }
    memcpy(data, &header, sizeof header);
    memcpy(data + sizeof header, body, body_size);
    const uint16_t sum = checksum(data, size);
    data[size++] = static_cast<uint8_t>(sum & 0xFF);
    data[size++] = static_cast<uint8_t>(sum >> 8);
    outbox.push(0);
    push_encoded(outbox, data, size);
    outbox.push(0);
}

}  // namespace pivotrig
