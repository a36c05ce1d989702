// What the board does with a message: everything that is not allowed is refused and counted, nothing is clipped.
#include "allowed.h"
#include "board.h"

namespace pivotrig {

void Board::receive(uint8_t byte) {
    if (decoder_.feed(byte)) {
        obey(decoder_.header());
    }
}

void Board::obey(const Header& header) {
    switch (static_cast<Code>(header.code)) {
        case Code::Hello:
            greet(header);
            break;
        case Code::Stop:
            stop(header.sequence);
            break;
        case Code::Drive:
        case Code::Configure:
            obey_in_sequence(header);
            break;
        default:  // what a board says
            refuse(Refusal::Direction);
            break;
    }
}

// Another version is answered too, so that both sides can say what is wrong.
void Board::greet(const Header& header) {
    send_banner(header.sequence);
    if (header.version != protocol_version) {
        refuse(Refusal::Version);
        return;
    }
    if (state_ == BoardCode::Fault) {
        is_configured_ = false;
        hash_ = 0;
    }
    become(is_configured_ ? BoardCode::Ready : BoardCode::Booted);
    latched_ = 0;
    is_greeted_ = true;
    last_sequence_ = header.sequence;
    ++good_;
}

void Board::stop(uint16_t sequence) {
    if (state_ != BoardCode::Booted && state_ != BoardCode::Fault) {
        become(BoardCode::Stopped);
    }
    if (is_fresh(sequence)) {
        last_sequence_ = sequence;
    }
    ++good_;
}

void Board::obey_in_sequence(const Header& header) {
    if (header.boot_id != boot_id_) {
        refuse(Refusal::BootId);
    } else if (!is_fresh(header.sequence)) {
        ++stale_;
        last_refusal_ = Refusal::Sequence;
    } else {
        last_sequence_ = header.sequence;  // a refused number is used up: it cannot be replayed later
        if (header.code == static_cast<uint8_t>(Code::Configure)) {
            configure(header.sequence);
        } else {
            drive();
        }
    }
}

bool Board::is_fresh(uint16_t sequence) const {
    const uint16_t distance = static_cast<uint16_t>(sequence - last_sequence_);
    return 1 <= distance && distance <= sequence_window;
}

void Board::refuse(Refusal reason) {
    ++refused_;
    last_refusal_ = reason;
}

void Board::configure(uint16_t sequence) {
    if (!is_greeted_ || is_driving() || state_ == BoardCode::Fault) {
        refuse(Refusal::State);
        return;
    }
    Configure message;
    decoder_.read(message);
    if (!is_allowed(message)) {
        refuse(Refusal::Configuration);
        return;
    }
    ++good_;
    take_over(message);
    become(BoardCode::Ready);
    send_banner(sequence);
}

void Board::take_over(const Configure& message) {
    const uint16_t sum = checksum(decoder_.body(), configure_length);
    is_configured_ = true;
    hash_ = sum != 0 ? sum : uint16_t(1);  // 0 is kept for a board that has none
    max_rate_ = static_cast<int32_t>(message.max_rate);
    max_tilt_ = message.max_tilt;
    max_field_ = message.max_field;
    dead_man_ = message.dead_man;
    motion_.configure(message.ramp, message.field_slew);
    coils_.configure(message);
}

void Board::drive() {
    Drive message;
    decoder_.read(message);
    const Refusal refusal = objection(message);
    if (refusal != Refusal::None) {
        refuse(refusal);
        return;
    }
    ++good_;
    if (message.flags & arm) {
        become(BoardCode::Driving);
        motion_.start(message);
    } else {
        motion_.follow(message);
    }
    coils_.allocate(message);
    life_ = message.time_to_live < dead_man_ ? message.time_to_live : dead_man_;
}

Refusal Board::objection(const Drive& message) const {
    const bool arms = message.flags & arm;
    if (!is_configured_ || state_ == BoardCode::Fault || (!is_driving() && !arms)) {
        return Refusal::State;
    }
    if (message.flags != 0 && message.flags != arm) {
        return Refusal::Flags;
    }
    if (message.pivot != 1 && message.pivot != -1) {
        return Refusal::Pivot;
    }
    if (message.rate < -max_rate_ || message.rate > max_rate_) {
        return Refusal::Rate;
    }
    if (message.tilt > max_tilt_) {
        return Refusal::Tilt;
    }
    if (message.field > max_field_) {
        return Refusal::Field;
    }
    return message.time_to_live == 0 ? Refusal::Lifetime : Refusal::None;
}

}  // namespace pivotrig
