#include "coil.h"

#include "fixed_point.h"

namespace pivotrig {

void Coil::rest() {
    duty = 0;
    commanded = 0;
    regulator.rest();
}

void Coil::want(const Field& field) {
    constexpr int32_t half = int32_t(1) << (allocation_bits - 1);
    const int32_t sum = product(allocation[0], field.x) + product(allocation[1], field.y) +
                        product(allocation[2], field.z);
    wanted = shifted_down<allocation_bits>(sum + half);
    commanded = static_cast<int16_t>(wanted);
}

bool Coil::is_beyond_limit() const { return absolute(wanted) > limit; }

// Halves, rounded up, have 16 bits: up to 113 A.
uint16_t Coil::half_wanted() const { return static_cast<uint16_t>((absolute(wanted) + 1) >> 1); }

bool Coil::is_farther_beyond_than(const Coil& other) const {
    return product(half_wanted(), other.half_limit) > product(other.half_wanted(), half_limit);
}

int16_t Coil::share_within_limit() const {
    return static_cast<int16_t>(quotient<allocation_bits>(half_limit, half_wanted()));
}

}  // namespace pivotrig
