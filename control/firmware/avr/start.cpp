#include "start.h"

#include <avr/eeprom.h>
#include <avr/pgmspace.h>
#include <avr/wdt.h>

#include "../portable/boot_count.h"
#include "../portable/reset_cause.h"
#include "registers.h"

namespace {

// Written before the C runtime clears memory, so they are kept out of what it clears.
uint8_t flags_of_processor __attribute__((section(".noinit")));
uint8_t flags_in_r2 __attribute__((section(".noinit")));

}  // namespace

// After a watchdog reset the watchdog runs on with its shortest period: it is stopped before anything else.
extern "C" void keep_reset_flags() __attribute__((naked, used, section(".init3")));
void keep_reset_flags() {
    __asm__ __volatile__("mov %0, r2" : "=r"(flags_in_r2));
    flags_of_processor = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

namespace pivotrig {
namespace start {

namespace {

// Optiboot keeps its version in the last two bytes of the flash, and from 4.6 on hands MCUSR over in register 2; the
// 4.4 of a stock UNO clears the flags and says nothing.
constexpr uint16_t bootloader_minor = FLASHEND - 1;
constexpr uint16_t bootloader_major = FLASHEND;
constexpr uint16_t first_that_hands_over = 0x0406;
constexpr uint16_t empty_flash = 0xFFFF;

BootRecord* record_at(uint8_t slot) { return reinterpret_cast<BootRecord*>(slot * sizeof(BootRecord)); }

bool bootloader_hands_over() {
    const uint16_t major = pgm_read_byte(bootloader_major);
    const uint16_t version = static_cast<uint16_t>((major << 8) | pgm_read_byte(bootloader_minor));
    return version >= first_that_hands_over && version != empty_flash;
}

}  // namespace

ResetCause cause() {
    if (flags_of_processor != 0) {
        return reset_cause(flags_of_processor);
    }
    return reset_cause(bootloader_hands_over() ? flags_in_r2 : uint8_t(0));
}

uint16_t count_boot() {
    BootCount count;
    for (uint8_t slot = 0; slot < boot_record_count; ++slot) {
        BootRecord record;
        eeprom_read_block(&record, record_at(slot), sizeof record);
        count.see(slot, record);
    }
    const BootRecord record = count.record();
    eeprom_update_block(&record, record_at(count.slot()), sizeof record);
    return record.id;
}

}  // namespace start
}  // namespace pivotrig
