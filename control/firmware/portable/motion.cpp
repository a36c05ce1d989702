#include "motion.h"

#include "fixed_point.h"

namespace pivotrig {

namespace {

// Compares distances, since value + step might leave 32 bits.
int32_t towards(int32_t value, int32_t goal, int32_t step) {
    const int32_t distance = goal - value;
    if (distance > step) {
        return value + step;
    }
    if (distance < -step) {
        return value - step;
    }
    return goal;
}

int32_t elevation_of(const Drive& drive) {
    const int32_t tilt = drive.tilt;
    return (drive.pivot > 0 ? -tilt : tilt) * 65536;
}

int32_t larger(int32_t one, int32_t other) { return one > other ? one : other; }

}  // namespace

void FieldMotion::configure(uint16_t ramp, uint16_t slew) {
    // Rounded up, so that a swing takes the ramp's milliseconds and not one more.
    ramp_ = (65536 + static_cast<int32_t>(ramp) - 1) / ramp;
    slew_ = slew;
}

void FieldMotion::rest() {
    magnitude_ = 0;
    magnitude_goal_ = 0;
    rate_ = 0;
}

void FieldMotion::start(const Drive& drive) {
    heading_ = drive.start_heading;
    magnitude_ = 0;
    elevation_ = elevation_of(drive);
    follow(drive);
}

void FieldMotion::follow(const Drive& drive) {
    goal_ = drive.heading_goal;
    rate_ = drive.rate;
    magnitude_goal_ = static_cast<int32_t>(drive.field) * 256;
    const int32_t goal = elevation_of(drive);
    if (goal != elevation_goal_) {
        elevation_goal_ = goal;
        const int32_t swing = larger(1, larger(absolute(goal), absolute(elevation_)) >> 16);
        elevation_step_ = 2 * swing * ramp_;
    }
}

void FieldMotion::advance() {
    if (elevation_ != elevation_goal_) {
        elevation_ = towards(elevation_, elevation_goal_, elevation_step_);
    } else if (rate_ != 0) {
        turn();
    }
    if (magnitude_ != magnitude_goal_) {
        magnitude_ = towards(magnitude_, magnitude_goal_, slew_);
    }
}

// Towards the goal and never past it; a goal that lies behind means standing still.
void FieldMotion::turn() {
    const int32_t distance = static_cast<int32_t>(goal_ - heading_);
    const bool is_ahead = rate_ > 0 ? distance > 0 : distance < 0;
    if (!is_ahead) {
        return;
    }
    const bool is_farther = rate_ > 0 ? distance > rate_ : distance < rate_;
    heading_ = is_farther ? heading_ + static_cast<uint32_t>(rate_) : goal_;
}

}  // namespace pivotrig
