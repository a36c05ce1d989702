// Integer arithmetic of the board: the Q15 sine over a 16-bit binary angle, and shifts and quotients that an 8-bit
// processor without a barrel shifter or a divider does fast.
#ifndef PIVOTRIG_FIXED_POINT_H
#define PIVOTRIG_FIXED_POINT_H

#include <stdint.h>

namespace pivotrig {

// sin of a binary angle (65536 = one turn) in Q15.
int16_t sine(uint16_t angle);

inline int32_t absolute(int32_t value) { return value < 0 ? -value : value; }

// Products of 16 bits in 32.
inline int32_t product(int16_t one, int16_t other) { return static_cast<int32_t>(one) * other; }
inline uint32_t product(uint16_t one, uint16_t other) { return static_cast<uint32_t>(one) * other; }

// value >> BITS, rounded towards minus infinity. Whole bytes are moved and the rest goes two bits at a time: a compiler
// for eight bits makes a loop of 7 cycles a bit of anything longer.
template <uint8_t BITS>
inline int32_t shifted_down(int32_t value) {
    constexpr uint8_t rest = BITS % 8;
    value >>= BITS - rest;
    for (uint8_t pair = 0; pair < rest / 2; ++pair) {
        value >>= 2;
        __asm__("" : "+r"(value));  // keeps the compiler from joining the pieces again
    }
    return rest % 2 == 0 ? value : value >> 1;
}

// value >> 6 for magnitudes below 2^29.
inline int32_t shifted_down_6(int32_t value) { return (value * 4) >> 8; }

// value >> (16 - BITS) where that fits 16 bits.
template <uint8_t BITS>
inline int16_t upper_half(int32_t value) {
    const uint32_t pattern = static_cast<uint32_t>(value);
    const uint8_t below = static_cast<uint8_t>(pattern >> 8);
    return static_cast<int16_t>(static_cast<uint16_t>((pattern >> 16) << BITS) | (below >> (8 - BITS)));
}

// (numerator << BITS) / denominator, rounded down, for a numerator below the denominator.
template <uint8_t BITS>
inline uint16_t quotient(uint16_t numerator, uint16_t denominator) {
    uint16_t result = 0;
    for (uint8_t place = 0; place < BITS; ++place) {
        const bool carry = numerator & 0x8000;
        numerator = static_cast<uint16_t>(numerator + numerator);
        result = static_cast<uint16_t>(result + result);
        if (carry || numerator >= denominator) {
            numerator = static_cast<uint16_t>(numerator - denominator);
            ++result;
        }
    }
    return result;
}

}  // namespace pivotrig

#endif
