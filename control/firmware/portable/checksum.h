// The CRC-16 of the wire: polynomial 0x1021, most significant bit first, starting at 0xFFFF.
#ifndef PIVOTRIG_CHECKSUM_H
#define PIVOTRIG_CHECKSUM_H

#include <stdint.h>

namespace pivotrig {

class Checksum {
 public:
    void add(uint8_t byte) {
        uint8_t high = static_cast<uint8_t>((value_ >> 8) ^ byte);
        high = static_cast<uint8_t>(high ^ (high >> 4));
        const uint16_t moved = static_cast<uint16_t>(value_ << 8);
        const uint16_t folded = static_cast<uint16_t>((high << 12) ^ (high << 5) ^ high);
        value_ = static_cast<uint16_t>(moved ^ folded);
    }

    uint16_t value() const { return value_; }

 private:
    uint16_t value_ = 0xFFFF;
};

inline uint16_t checksum(const uint8_t* data, uint8_t size) {
    Checksum sum;
    for (uint8_t place = 0; place < size; ++place) {
        sum.add(data[place]);
    }
    return sum.value();
}

}  // namespace pivotrig

#endif
