// Messages to framed bytes and back: 0x00, COBS(header, body, CRC-16), 0x00.
#ifndef PIVOTRIG_FRAME_H
#define PIVOTRIG_FRAME_H

#include <stdint.h>
#include <string.h>

#include "checksum.h"
#include "contract.h"
#include "ring.h"

namespace pivotrig {

struct __attribute__((packed)) Header {
    uint8_t code;
    uint8_t version;
    uint16_t sequence;
    uint16_t boot_id;
};

constexpr uint8_t checksum_length = 2;
constexpr uint8_t most_body = longest_frame - 1 - sizeof(Header) - checksum_length;

// Bytes in, messages out; whatever is broken is counted and forgotten.
class Decoder {
 public:
    // Takes one byte; true when it completes a message, which stays until the next byte.
    bool feed(uint8_t byte);

    Header header() const {
        Header header;
        memcpy(&header, data_, sizeof header);
        return header;
    }

    // Body must be the structure of the header's code.
    template <class Body>
    void read(Body& body) const {
        memcpy(&body, data_ + sizeof(Header), sizeof body);
    }

    const uint8_t* body() const { return data_ + sizeof(Header); }

    // Frames that yielded no message.
    uint16_t dropped() const { return dropped_; }

 private:
    bool finish();
    bool is_whole() const;
    bool is_known() const;
    void store(uint8_t byte);
    void restart();

    uint8_t data_[longest_frame] = {};
    Checksum sum_;              // of all stored bytes but the last two, which may be the frame's own
    uint8_t received_ = 0;      // encoded bytes since the delimiter
    uint8_t size_ = 0;          // decoded ones
    uint8_t until_code_ = 0;    // bytes before the next code byte
    bool is_skipping_ = false;  // the frame is too long
    uint16_t dropped_ = 0;
};

using Outbox = Ring<256>;

// Queues a message; without room for all of it nothing is queued.
void send(Outbox& outbox, const Header& header, const void* body, uint8_t body_size);

}  // namespace pivotrig

#endif
