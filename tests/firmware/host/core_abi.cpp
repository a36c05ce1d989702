// The firmware's core behind C functions, for a test in another language. A tick is followed by its report at once.
#include "../../../control/firmware/portable/board.h"
#include "../../../control/firmware/portable/boot_count.h"
#include "../../../control/firmware/portable/fixed_point.h"
#include "../../../control/firmware/portable/reset_cause.h"

using pivotrig::Board;

extern "C" {

Board* board_boot(uint16_t boot_id, uint8_t cause) {
    Board* board = new Board;
    board->boot(boot_id, static_cast<pivotrig::ResetCause>(cause));
    return board;
}

void board_delete(Board* board) { delete board; }

void board_receive(Board* board, const uint8_t* data, uint32_t size) {
    for (uint32_t place = 0; place < size; ++place) {
        board->receive(data[place]);
    }
}

// readings: three currents and the supply, ADC counts.  duty: signed PWM steps.
void board_tick(Board* board, const uint16_t* readings, uint8_t driver_fault, int16_t* duty) {
    board->tick({{readings[0], readings[1], readings[2]}, readings[3], driver_fault != 0});
    if (board->has_report()) {
        board->report();
    }
    for (uint8_t coil = 0; coil < pivotrig::coil_count; ++coil) {
        duty[coil] = board->coils().duty(coil);
    }
}

uint8_t board_state(const Board* board) { return static_cast<uint8_t>(board->state()); }

uint32_t board_transmit(Board* board, uint8_t* data, uint32_t most) {
    uint32_t taken = 0;
    while (taken < most && !board->outbox().is_empty()) {
        data[taken++] = board->outbox().pop();
    }
    return taken;
}

int16_t core_sine(uint16_t angle) { return pivotrig::sine(angle); }

uint8_t core_reset_cause(uint8_t flags) { return static_cast<uint8_t>(pivotrig::reset_cause(flags)); }

uint8_t core_reset_cause_handed_over(uint16_t bootloader, uint8_t flags) {
    return static_cast<uint8_t>(pivotrig::reset_cause_handed_over(bootloader, flags));
}

// records: boot_record_count pairs of id and complement, of which one is rewritten. Returns the new boot id.
uint16_t core_count_boot(uint16_t* records) {
    pivotrig::BootCount count;
    for (uint8_t slot = 0; slot < pivotrig::boot_record_count; ++slot) {
        count.see(slot, {records[2 * slot], records[2 * slot + 1]});
    }
    records[2 * count.slot()] = count.record().id;
    records[2 * count.slot() + 1] = count.record().complement;
    return count.record().id;
}

}  // extern "C"
