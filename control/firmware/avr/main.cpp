// The firmware of an Arduino UNO (ATmega328P, 16 MHz): the board of `core` on its timers, pins and serial line.
//
// Two contexts share the board. The timer's interrupt runs the tick, with the serial line's interrupts let in; the main
// loop takes the bytes, with the tick kept out for each one, and turns a finished report into bytes before it takes the
// next. So bytes, ticks and messages have one order.
#include <avr/interrupt.h>
#include <avr/wdt.h>

#include "../portable/board.h"
#include "bridges.h"
#include "registers.h"
#include "sensing.h"
#include "serial.h"
#include "start.h"

// What the running tick has sensed, which an emulator reads here when GPIOR0 becomes 1; and who and how the board is.
extern "C" {
pivotrig::Readings sensed __attribute__((used, externally_visible));

struct {
    uint16_t boot_id;
    pivotrig::BoardCode state;
} shown __attribute__((used, externally_visible));
}

namespace pivotrig {

namespace {

// Timer 0: 16 MHz / 64 / 250 = 1 kHz; the ADC starts its round in the middle.
constexpr uint8_t ticks_of_period = 250;
constexpr uint8_t ticks_until_sensing = 125;

Board board;
volatile bool has_ticked;

// While it lives no tick runs; a tick that falls due waits.
class TickPause {
 public:
    TickPause() {
        clear(TIMSK0, OCIE0A);
        barrier();
    }
    ~TickPause() {
        barrier();
        set(TIMSK0, OCIE0A);
    }
};

void begin_timer() {
    OCR0A = ticks_of_period - 1;
    OCR0B = ticks_until_sensing - 1;
    TCCR0A = bit(WGM01);
    TCCR0B = bit(CS01) | bit(CS00);
    TIMSK0 = bit(OCIE0A) | bit(OCIE0B);
}

void begin() {
    bridges::begin();
    const ResetCause cause = start::cause();
    sensing::begin();
    serial::begin(board.outbox());
    shown.boot_id = start::count_boot();
    board.boot(shown.boot_id, cause);
    begin_timer();
    wdt_enable(WDTO_250MS);
    sei();
}

void tick() {
    board.tick(sensed);
    if (board.is_driving()) {
        bridges::drive(board.coils());
    } else {
        bridges::settle(sensed.currents);
    }
    shown.state = board.state();
    has_ticked = true;
}

void take_byte() {
    if (serial::inbox.is_empty()) {
        return;
    }
    TickPause pause;
    if (board.has_report()) {
        return;  // a tick came in between: its report goes first
    }
    const uint8_t byte = serial::inbox.pop();
    GPIOR1 = byte;
    board.receive(byte);
    shown.state = board.state();
    if (!board.is_driving()) {
        bridges::zero();
    }
}

// The watchdog is fed only while ticks and this loop both run.
void feed_watchdog() {
    if (has_ticked) {
        has_ticked = false;
        wdt_reset();
    }
}

// It does not sleep between two bytes: in idle mode an ATmega328P whose ADC is on starts a conversion by itself, which
// would get between those of a round and give a coil the current of another.
void run() {
    for (;;) {
        barrier();  // what interrupts have written is read anew in each round
        feed_watchdog();
        if (board.has_report()) {
            board.report();
        } else {
            take_byte();
        }
        serial::wake();
    }
}

}  // namespace

}  // namespace pivotrig

ISR(TIMER0_COMPA_vect) {
    using namespace pivotrig;
    clear(TIMSK0, OCIE0A);  // a tick does not interrupt a tick
    serial::pause();        // sending can wait half a millisecond, receiving cannot
    sensing::read(sensed);
    sensed.driver_fault = bridges::has_driver_fault();
    sei();
    GPIOR0 = 1;
    tick();
    GPIOR0 = 0;
    cli();
    serial::wake();
    set(TIMSK0, OCIE0A);
}

int main() {
    pivotrig::begin();
    pivotrig::run();
}
