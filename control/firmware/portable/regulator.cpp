#include "regulator.h"

#include "fixed_point.h"

namespace pivotrig {

namespace {

// Half of the way from an observed magnitude into the interval of the reading, both Q8.
int32_t within(int32_t magnitude, uint16_t counts, uint16_t gain) {
    const int32_t low = static_cast<int32_t>(static_cast<uint32_t>(counts) * gain);
    if (magnitude < low) {
        return magnitude + ((low - magnitude) >> 1);
    }
    if (magnitude > low + gain) {
        return magnitude - ((magnitude - low - gain) >> 1);
    }
    return magnitude;
}

}  // namespace

void Regulator::configure(uint16_t resistance, uint16_t inductance) {
    feed_ = static_cast<int16_t>((static_cast<uint32_t>(resistance) << 10) / 1000);
    model_ = static_cast<int16_t>(6553600 / (static_cast<uint32_t>(inductance) + resistance / 20));
    gain_ = static_cast<int16_t>((static_cast<uint32_t>(inductance) * 131) >> 8);
    lead_ = static_cast<int16_t>((static_cast<uint32_t>(inductance) * 164) >> 8);
}

void Regulator::sense_with(uint16_t forward, uint16_t reverse) {
    gains_[0] = forward;
    gains_[1] = reverse;
}

void Regulator::rest() {
    target_ = 0;
    integral_ = 0;
    dither_ = 0;
    voltage_ = 0;
}

int16_t Regulator::sensed(uint16_t counts) const {
    const uint32_t magnitude = (static_cast<uint32_t>(counts) * gains_[flows_backwards()]) >> 8;
    const int16_t shown = magnitude < uint32_t(most_sensed) ? static_cast<int16_t>(magnitude) : most_sensed;
    return flows_backwards() ? static_cast<int16_t>(-shown) : shown;
}

void Regulator::observe(uint16_t counts) {
    const int32_t drop = shifted_down<12>(shifted_down_6(current_) * feed_);
    const int32_t current = current_ + (((voltage_ - drop) * model_) >> 8);
    current_ = current < 0 ? -within(-current, counts, gains_[1]) : within(current, counts, gains_[0]);
}

int32_t Regulator::voltage_for(int16_t target, int32_t product) const {
    const int32_t resistive = shifted_down<10>(static_cast<int32_t>(target) * feed_);
    const int32_t inductive = shifted_down_6(static_cast<int32_t>(target - target_) * lead_);
    return resistive + inductive + shifted_down<10>(product + integral_);
}

int16_t Regulator::regulate(int16_t target, const Supply& supply) {
    const int32_t product = (static_cast<int32_t>(target) * 4 - shifted_down_6(current_)) * gain_;
    int32_t voltage = voltage_for(target, product);
    target_ = target;
    if (voltage > supply.limit) {
        voltage = supply.limit;
    } else if (voltage < -supply.limit) {
        voltage = -supply.limit;
    } else {
        const int32_t integral = integral_ + shifted_down<5>(product);
        if (-integral_limit <= integral && integral <= integral_limit) {
            integral_ = integral;
        }
    }
    const int32_t duty = ((voltage * supply.reciprocal) >> 8) + dither_;
    dither_ = static_cast<uint8_t>(duty & 0xFF);
    const int16_t steps = static_cast<int16_t>(duty >> 8);
    voltage_ = (steps * supply.volts) >> 8;
    return steps;
}

}  // namespace pivotrig
