#include "coil_drive.h"

#include <string.h>

#include "fixed_point.h"

namespace pivotrig {

namespace {

constexpr int32_t half_q15 = int32_t(1) << 14;

static_assert(allowed::current_limits.high * 320 / allowed::sense_gains.low < full_count, "a full sense trips");

// ADC counts at 1.25 times a limit in mA.
uint16_t trip_count(uint16_t limit, uint16_t gain) {
    return static_cast<uint16_t>(static_cast<uint32_t>(limit) * 320 / gain);
}

// Q8 mV of one step; scale: 2^22 over the steps.
int32_t volts_of_step(uint16_t supply, uint16_t scale) {
    const uint32_t pattern = product(supply, static_cast<uint16_t>(scale >> 1));
    return static_cast<int32_t>(((pattern >> 16) << 3) | (static_cast<uint8_t>(pattern >> 8) >> 5));
}

// |B| [cos e cos phi, cos e sin phi, sin e] with phi = heading + 90 deg.
Field field_of(const FieldMotion& motion) {
    const uint16_t heading = static_cast<uint16_t>(motion.heading() >> 16);
    const uint16_t elevation = static_cast<uint16_t>(motion.elevation() >> 16);
    const int16_t strength = static_cast<int16_t>(motion.magnitude() >> 8);
    const uint16_t across = static_cast<uint16_t>(elevation + quarter_turn);
    const uint16_t ahead = static_cast<uint16_t>(heading + quarter_turn);
    const int16_t level = upper_half<1>(product(strength, sine(across)) + half_q15);
    return {upper_half<1>(half_q15 - product(level, sine(heading))),
            upper_half<1>(product(level, sine(ahead)) + half_q15),
            upper_half<1>(product(strength, sine(elevation)) + half_q15)};
}

}  // namespace

void CoilDrive::configure(const Configure& message) {
    for (uint8_t place = 0; place < coil_count; ++place) {
        Coil& coil = coils_[place];
        const uint16_t limit = message.current_limits[place];
        const uint16_t forward = message.sense_gains[2 * place];
        const uint16_t reverse = message.sense_gains[2 * place + 1];
        coil.limit = static_cast<int16_t>(limit);
        coil.half_limit = limit >> 1;
        coil.trips[0] = trip_count(limit, forward);
        coil.trips[1] = trip_count(limit, reverse);
        coil.regulator.configure(message.resistances[place], message.inductances[place]);
        coil.regulator.sense_with(forward, reverse);
    }
    nominal_ = message.supply;
    low_supply_ = static_cast<uint16_t>((static_cast<uint32_t>(nominal_) * 3) >> 2);
    scale_ = message.supply_scale;
    is_supply_settled_ = false;
}

void CoilDrive::allocate(const Drive& drive) {
    for (uint8_t place = 0; place < coil_count; ++place) {
        memcpy(coils_[place].allocation, drive.allocation + 3 * place, sizeof coils_[place].allocation);
    }
}

void CoilDrive::rest() {
    for (Coil& coil : coils_) {
        coil.rest();
    }
    is_saturated_ = false;
    over_current_ = 0;
}

void CoilDrive::sense(const Readings& readings) {
    for (uint8_t place = 0; place < coil_count; ++place) {
        coils_[place].counts = readings.currents[place];
    }
    supply_ = static_cast<uint16_t>(shifted_down<10>(static_cast<int32_t>(product(readings.supply, scale_))));
    is_supply_low_ = scale_ != 0 && supply_ < low_supply_;
}

void CoilDrive::coast() {
    for (Coil& coil : coils_) {
        coil.regulator.observe(coil.counts);
    }
}

bool CoilDrive::is_over_current() {
    bool is_above = false;
    for (const Coil& coil : coils_) {
        is_above |= coil.is_over_current();
    }
    over_current_ = is_above ? static_cast<uint8_t>(over_current_ + 1) : uint8_t(0);
    return over_current_ >= over_current_ticks;
}

void CoilDrive::advance(const FieldMotion& motion) {
    const uint16_t supply = scale_ != 0 ? supply_ : nominal_;
    if (!is_supply_settled_ || supply != settled_supply_) {
        settle_supply(supply);
    }
    aim(motion);
    regulate();
}

void CoilDrive::aim(const FieldMotion& motion) {
    const Field field = field_of(motion);
    for (Coil& coil : coils_) {
        coil.want(field);
    }
    const Coil* farthest = farthest_beyond_limit();
    is_saturated_ = farthest != nullptr;
    if (is_saturated_) {
        scale_back(farthest->share_within_limit());
    }
}

// The coil that is beyond its limit by the largest factor, if any is.
const Coil* CoilDrive::farthest_beyond_limit() const {
    const Coil* farthest = nullptr;
    for (const Coil& coil : coils_) {
        if (coil.is_beyond_limit() && (farthest == nullptr || coil.is_farther_beyond_than(*farthest))) {
            farthest = &coil;
        }
    }
    return farthest;
}

// All three by the same factor (Q14), so that the direction of the field stays.
void CoilDrive::scale_back(int16_t share) {
    for (Coil& coil : coils_) {
        coil.commanded = upper_half<16 - allocation_bits>(coil.wanted * share);
    }
}

// Everything that it calls becomes part of it: three times the saving and restoring of half of the registers is more
// than the flash is worth.
__attribute__((flatten)) void CoilDrive::regulate() {
    for (Coil& coil : coils_) {
        coil.regulator.observe(coil.counts);
        coil.duty = coil.regulator.regulate(coil.commanded, &coil == coils_ + 2 ? coarse_ : fine_);
    }
}

// A weak supply raises the duty to twice the nominal at most.
void CoilDrive::settle_supply(uint16_t supply) {
    static_assert(pwm_steps[0] == pwm_steps[1] && pwm_steps[0] == 8 * pwm_steps[2], "one quotient for both");
    settled_supply_ = supply;
    is_supply_settled_ = true;
    const uint16_t half_nominal = nominal_ >> 1;
    const uint16_t trusted = supply > half_nominal ? supply : half_nominal;
    fine_.limit = coarse_.limit = trusted;
    fine_.volts = volts_of_step(supply, duty_scale[0]);
    coarse_.volts = volts_of_step(supply, duty_scale[2]);
    const uint16_t reciprocal = quotient<16>(pwm_steps[0], trusted);
    fine_.reciprocal = static_cast<int16_t>(reciprocal);
    coarse_.reciprocal = static_cast<int16_t>(reciprocal >> 3);
}

uint16_t CoilDrive::describe(Telemetry& report) const {
    for (uint8_t place = 0; place < coil_count; ++place) {
        const Coil& coil = coils_[place];
        report.commanded[place] = coil.commanded;
        report.measured[place] = coil.regulator.sensed(coil.counts);
        report.duty[place] = static_cast<int16_t>((static_cast<int32_t>(coil.duty) * duty_scale[place]) >> 7);
    }
    report.supply = supply_;
    uint16_t flags = is_saturated_ ? saturated_flag : uint16_t(0);
    flags = static_cast<uint16_t>(flags | (is_supply_low_ ? supply_low_flag : 0));
    return static_cast<uint16_t>(flags | (scale_ == 0 ? supply_assumed_flag : 0));
}

}  // namespace pivotrig
