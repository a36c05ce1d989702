#include "allowed.h"

namespace pivotrig {

namespace {

bool is_within(uint32_t value, const Range& range) { return range.low <= value && value <= range.high; }

bool is_coil_allowed(const Configure& message, uint8_t coil) {
    const uint16_t resistance = message.resistances[coil];
    const uint16_t inductance = message.inductances[coil];
    return is_within(message.current_limits[coil], allowed::current_limits) &&
           is_within(resistance, allowed::resistances) && is_within(inductance, allowed::inductances) &&
           is_within(message.sense_gains[2 * coil], allowed::sense_gains) &&
           is_within(message.sense_gains[2 * coil + 1], allowed::sense_gains) &&
           2 * static_cast<uint32_t>(inductance) >= resistance;
}

}  // namespace

bool is_allowed(const Configure& message) {
    return is_coil_allowed(message, 0) && is_coil_allowed(message, 1) && is_coil_allowed(message, 2) &&
           is_within(message.dead_man, allowed::dead_man) && is_within(message.ramp, allowed::ramp) &&
           is_within(message.field_slew, allowed::field_slew) && is_within(message.supply, allowed::supply) &&
           is_within(message.max_field, allowed::max_field) && is_within(message.max_rate, allowed::max_rate) &&
           is_within(message.max_tilt, allowed::max_tilt) && is_within(message.supply_scale, allowed::supply_scale);
}

}  // namespace pivotrig
