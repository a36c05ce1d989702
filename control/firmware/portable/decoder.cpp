#include "frame.h"

namespace pivotrig {

namespace {

constexpr uint8_t not_a_code = 0xFF;

uint8_t body_length(uint8_t code) {
    switch (static_cast<Code>(code)) {
        case Code::Hello:
            return hello_length;
        case Code::Banner:
            return banner_length;
        case Code::Configure:
            return configure_length;
        case Code::Drive:
            return drive_length;
        case Code::Stop:
            return stop_length;
        case Code::Telemetry:
            return telemetry_length;
    }
    return not_a_code;
}

// The layouts of Hello and Banner never change, so that two versions can tell each other apart.
bool is_of_any_version(uint8_t code) {
    return code == static_cast<uint8_t>(Code::Hello) || code == static_cast<uint8_t>(Code::Banner);
}

}  // namespace

bool Decoder::feed(uint8_t byte) {
    if (byte == 0) {
        return finish();
    }
    if (is_skipping_) {
        return false;
    }
    if (received_ == longest_frame) {
        is_skipping_ = true;
        ++dropped_;
        return false;
    }
    if (until_code_ != 0) {
        --until_code_;
        store(byte);
    } else {
        until_code_ = static_cast<uint8_t>(byte - 1);
        if (received_ != 0) {
            store(0);
        }
    }
    ++received_;
    return false;
}

void Decoder::store(uint8_t byte) {
    if (size_ >= checksum_length) {
        sum_.add(data_[size_ - checksum_length]);
    }
    data_[size_] = byte;
    ++size_;
}

bool Decoder::finish() {
    const bool is_frame = received_ != 0 && !is_skipping_;
    const bool is_message = is_frame && is_whole() && is_known();
    if (is_frame && !is_message) {
        ++dropped_;
    }
    restart();
    return is_message;
}

bool Decoder::is_whole() const {
    if (until_code_ != 0 || size_ < sizeof(Header) + checksum_length) {
        return false;
    }
    const uint8_t* sent = data_ + size_ - checksum_length;
    return sum_.value() == static_cast<uint16_t>(sent[0] | (sent[1] << 8));
}

bool Decoder::is_known() const {
    const Header it = header();
    if (it.version != protocol_version && !is_of_any_version(it.code)) {
        return false;
    }
    return size_ - sizeof(Header) - checksum_length == body_length(it.code);
}

void Decoder::restart() {
    sum_ = Checksum();
    received_ = 0;
    size_ = 0;
    until_code_ = 0;
    is_skipping_ = false;
}

}  // namespace pivotrig
