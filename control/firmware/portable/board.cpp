#include "board.h"

namespace pivotrig {

void Board::boot(uint16_t boot_id, ResetCause cause) {
    boot_id_ = boot_id;
    cause_ = cause;
    send_banner(0);
}

void Board::tick(const Readings& readings) {
    ++milliseconds_;
    coils_.sense(readings);
    if (is_driving()) {
        check_life_and_coils(readings.driver_fault);
    }
    if (is_driving()) {
        motion_.advance();
        coils_.advance(motion_);
    } else {
        coils_.coast();
    }
    if (is_greeted_) {
        count_down_to_report();
    }
}

void Board::check_life_and_coils(bool driver_fault) {
    --life_;
    const bool over_current = coils_.is_over_current();
    if (over_current || driver_fault) {
        latched_ = static_cast<uint16_t>(latched_ | (over_current ? over_current_flag : driver_fault_flag));
        become(BoardCode::Fault);
    } else if (life_ == 0) {
        become(BoardCode::Expired);
    }
}

// Every change of state starts from zero output.
void Board::become(BoardCode state) {
    state_ = state;
    motion_.rest();
    coils_.rest();
}

void Board::count_down_to_report() {
    --until_report_;
    if (until_report_ == 0) {
        until_report_ = telemetry_period;
        ++report_sequence_;
        describe();
        has_report_ = true;
    }
}

void Board::describe() {
    const uint16_t conditions = coils_.describe(report_);
    report_.time = milliseconds_;
    report_.heading = motion_.heading();
    report_.elevation = static_cast<int16_t>(motion_.elevation() >> 16);
    report_.state = static_cast<uint8_t>(state_);
    report_.flags = static_cast<uint16_t>(latched_ | conditions);
    report_.last_sequence = last_sequence_;
    report_.good = good_;
    report_.bad = decoder_.dropped();
    report_.refused = refused_;
    report_.stale = stale_;
    report_.last_refusal = static_cast<uint8_t>(last_refusal_);
    report_.configuration_hash = hash_;
}

void Board::report() {
    const Header header = {static_cast<uint8_t>(Code::Telemetry), protocol_version, report_sequence_, boot_id_};
    send(outbox_, header, &report_, sizeof report_);
    has_report_ = false;
}

void Board::send_banner(uint16_t sequence) {
    const Header header = {static_cast<uint8_t>(Code::Banner), protocol_version, sequence, boot_id_};
    const Banner banner = {{firmware_major, firmware_minor, firmware_patch}, static_cast<uint8_t>(cause_), hash_};
    send(outbox_, header, &banner, sizeof banner);
}

}  // namespace pivotrig
