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

// Optiboot keeps its version in the last two bytes of the flash.
constexpr uint16_t bootloader_version = FLASHEND - 1;

BootRecord* record_at(uint8_t slot) { return reinterpret_cast<BootRecord*>(slot * sizeof(BootRecord)); }

}  // namespace

ResetCause cause() {
    if (flags_of_processor != 0) {
        return reset_cause(flags_of_processor);
    }
    return reset_cause_handed_over(pgm_read_word(bootloader_version), flags_in_r2);
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
