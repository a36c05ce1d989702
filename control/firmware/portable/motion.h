// How the commanded field moves from one millisecond to the next.
#ifndef PIVOTRIG_MOTION_H
#define PIVOTRIG_MOTION_H

#include <stdint.h>

#include "contract.h"

namespace pivotrig {

class FieldMotion {
 public:
    // ramp: ms of a full elevation swing.  slew: uT/256 per ms.
    void configure(uint16_t ramp, uint16_t slew);

    // No field: standing still at the heading where it was.
    void rest();

    // The arm edge: heading and elevation are set while the field is zero, and the field ramps up.
    void start(const Drive& drive);

    void follow(const Drive& drive);

    // One millisecond.
    void advance();

    uint32_t heading() const { return heading_; }     // 2^32 = one turn
    int32_t elevation() const { return elevation_; }  // the same scale
    int32_t magnitude() const { return magnitude_; }  // uT, Q8

 private:
    void turn();

    uint32_t heading_ = 0;
    uint32_t goal_ = 0;
    int32_t rate_ = 0;
    int32_t elevation_ = 0;
    int32_t elevation_goal_ = 0;
    int32_t elevation_step_ = 0;
    int32_t magnitude_ = 0;
    int32_t magnitude_goal_ = 0;
    int32_t ramp_ = 0;
    int32_t slew_ = 0;
};

}  // namespace pivotrig

#endif
