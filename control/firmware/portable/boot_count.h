// The boot id: a 16-bit count of boots, never 0, kept in a ring of EEPROM records so that no cell wears out.
#ifndef PIVOTRIG_BOOT_COUNT_H
#define PIVOTRIG_BOOT_COUNT_H

#include <stdint.h>

namespace pivotrig {

// As it lies in the EEPROM; a record that was cut short by a power failure does not match its complement.
struct BootRecord {
    uint16_t id;
    uint16_t complement;
};

constexpr uint8_t boot_record_count = 128;

// Shown every record once, in order, it says which one this boot writes and with which id.
class BootCount {
 public:
    void see(uint8_t slot, const BootRecord& record);

    uint8_t slot() const { return slot_; }

    BootRecord record() const { return {id_, static_cast<uint16_t>(~id_)}; }

 private:
    bool has_seen_ = false;
    uint8_t slot_ = 0;
    uint16_t id_ = 1;
};

}  // namespace pivotrig

#endif
