#include "fixed_point.h"

#include "contract.h"

namespace pivotrig {

int16_t sine(uint16_t angle) {
    uint16_t offset = angle & (quarter_turn - 1);
    if (angle & quarter_turn) {
        offset = static_cast<uint16_t>(quarter_turn - offset);
    }
    const int16_t* place = quarter_wave + (offset >> 6);
    const uint8_t fraction = offset & 63;
    int16_t value = read_flash(place);
    if (fraction != 0) {
        // The wave rises by at most 201 from one entry to the next: the product fits 16 bits.
        const int16_t rise = static_cast<int16_t>(read_flash(place + 1) - value);
        value = static_cast<int16_t>(value + ((rise * fraction + 32) >> 6));
    }
    return (angle & 0x8000) ? static_cast<int16_t>(-value) : value;
}

}  // namespace pivotrig
