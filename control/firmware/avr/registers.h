// Single bits of the processor's registers. Within the range of SBI and CBI these are one instruction, which an
// interrupt cannot split.
#ifndef PIVOTRIG_REGISTERS_H
#define PIVOTRIG_REGISTERS_H

#include <avr/io.h>
#include <stdint.h>

namespace pivotrig {

using Register = volatile uint8_t;

constexpr uint8_t bit(uint8_t place) { return static_cast<uint8_t>(1 << place); }

inline __attribute__((always_inline)) void set(Register& reg, uint8_t place) {
    reg = static_cast<uint8_t>(reg | bit(place));
}

inline __attribute__((always_inline)) void clear(Register& reg, uint8_t place) {
    reg = static_cast<uint8_t>(reg & static_cast<uint8_t>(~bit(place)));
}

inline __attribute__((always_inline)) bool is_set(const Register& reg, uint8_t place) {
    return (reg & bit(place)) != 0;
}

// Keeps the compiler from moving accesses to shared memory across this point.
inline __attribute__((always_inline)) void barrier() { __asm__ __volatile__("" ::: "memory"); }

}  // namespace pivotrig

#endif
