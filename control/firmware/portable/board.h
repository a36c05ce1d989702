// The board: what it obeys, and the one millisecond in which it senses and drives.
//
// `receive` and `report` belong to one context (the main loop), `tick` to another (the timer's interrupt); the caller
// keeps a tick out of `receive`. A report is put together in the tick and turned into bytes by `report`.
#ifndef PIVOTRIG_BOARD_H
#define PIVOTRIG_BOARD_H

#include <stdint.h>

#include "coil_drive.h"
#include "contract.h"
#include "frame.h"
#include "motion.h"

namespace pivotrig {

class Board {
 public:
    // One boot: everything else is as it was constructed.
    void boot(uint16_t boot_id, ResetCause cause);

    // One byte from the host.
    void receive(uint8_t byte);

    // One millisecond.
    void tick(const Readings& readings);

    bool has_report() const { return has_report_; }

    // Queues the report that the last tick put together.
    void report();

    bool is_driving() const { return state_ == BoardCode::Driving; }

    BoardCode state() const { return state_; }

    // With every duty zero unless driving.
    const CoilDrive& coils() const { return coils_; }

    Outbox& outbox() { return outbox_; }

 private:
    void obey(const Header& header);
    void greet(const Header& header);
    void stop(uint16_t sequence);
    void obey_in_sequence(const Header& header);
    void configure(uint16_t sequence);
    void take_over(const Configure& message);
    void drive();
    Refusal objection(const Drive& message) const;
    bool is_fresh(uint16_t sequence) const;
    void refuse(Refusal reason);
    void become(BoardCode state);
    void check_life_and_coils(bool driver_fault);
    void count_down_to_report();
    void describe();
    void send_banner(uint16_t sequence);

    Decoder decoder_;
    Outbox outbox_;
    FieldMotion motion_;
    CoilDrive coils_;
    uint16_t boot_id_ = 0;
    ResetCause cause_ = ResetCause::Unknown;
    BoardCode state_ = BoardCode::Booted;
    bool is_greeted_ = false;
    bool is_configured_ = false;
    uint16_t hash_ = 0;
    int32_t max_rate_ = 0;
    uint16_t max_tilt_ = 0;
    uint16_t max_field_ = 0;
    uint16_t dead_man_ = 0;
    uint16_t life_ = 0;
    uint16_t latched_ = 0;
    uint32_t milliseconds_ = 0;
    uint8_t until_report_ = telemetry_period;
    uint16_t last_sequence_ = 0;
    uint16_t report_sequence_ = 0;
    uint16_t good_ = 0;
    uint16_t refused_ = 0;
    uint16_t stale_ = 0;
    Refusal last_refusal_ = Refusal::None;
    Telemetry report_ = {};
    volatile bool has_report_ = false;
};

}  // namespace pivotrig

#endif
