#include "boot_count.h"

namespace pivotrig {

namespace {

uint16_t following(uint16_t id) { return id == 0xFFFF ? uint16_t(1) : static_cast<uint16_t>(id + 1); }

}  // namespace

void BootCount::see(uint8_t slot, const BootRecord& record) {
    if (record.id == 0 || record.complement != static_cast<uint16_t>(~record.id)) {
        return;
    }
    // The ring spans 128 boots, so the newer of two ids is less than half of the numbers ahead.
    const uint16_t next = following(record.id);
    const bool is_newer = static_cast<uint16_t>(next - id_) < 0x8000;
    if (!has_seen_ || is_newer) {
        has_seen_ = true;
        id_ = next;
        slot_ = static_cast<uint8_t>((slot + 1) % boot_record_count);
    }
}

}  // namespace pivotrig
