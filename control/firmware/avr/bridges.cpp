#include "bridges.h"

#include "registers.h"

namespace pivotrig {
namespace bridges {

namespace {

// Sense counts (70 mA) below which a coil's current has died away.
constexpr uint16_t quiet_counts = 2;

// Milliseconds for which an enable line stays released after the drive, at least: three times the L/R of the largest
// coil. A sense that is dead reads quiet at full current too.
constexpr uint16_t shortest_decay = 150;

// Milliseconds after which an enable line goes low in any case: ten times the L/R of the largest coil.
constexpr uint16_t longest_decay = 500;

// Coil 1: INA D2, INB D4, EN/DIAG D6, PWM D9 (OC1A).
struct Bridge1 {
    static void begin() {
        set(DDRD, DDD2);
        set(DDRD, DDD4);
        set(DDRB, DDB1);
    }
    static void forward() {
        clear(PORTD, PORTD4);
        set(PORTD, PORTD2);
    }
    static void backward() {
        clear(PORTD, PORTD2);
        set(PORTD, PORTD4);
    }
    static void disable() { set(DDRD, DDD6); }
    static void enable() { clear(DDRD, DDD6); }
    static bool reads_low() { return !is_set(PIND, PIND6); }
    static void compare(uint16_t count) { OCR1A = count; }
    static void connect() { set(TCCR1A, COM1A1); }
    static void disconnect() { clear(TCCR1A, COM1A1); }
};

// Coil 2: INA D7, INB D8, EN/DIAG D12, PWM D10 (OC1B).
struct Bridge2 {
    static void begin() {
        set(DDRD, DDD7);
        set(DDRB, DDB0);
        set(DDRB, DDB2);
    }
    static void forward() {
        clear(PORTB, PORTB0);
        set(PORTD, PORTD7);
    }
    static void backward() {
        clear(PORTD, PORTD7);
        set(PORTB, PORTB0);
    }
    static void disable() { set(DDRB, DDB4); }
    static void enable() { clear(DDRB, DDB4); }
    static bool reads_low() { return !is_set(PINB, PINB4); }
    static void compare(uint16_t count) { OCR1B = count; }
    static void connect() { set(TCCR1A, COM1B1); }
    static void disconnect() { clear(TCCR1A, COM1B1); }
};

// Coil 3: INA D11, INB D5, EN/DIAG A3, PWM D3 (OC2B).
struct Bridge3 {
    static void begin() {
        set(DDRB, DDB3);
        set(DDRD, DDD5);
        set(DDRD, DDD3);
    }
    static void forward() {
        clear(PORTD, PORTD5);
        set(PORTB, PORTB3);
    }
    static void backward() {
        clear(PORTB, PORTB3);
        set(PORTD, PORTD5);
    }
    static void disable() { set(DDRC, DDC3); }
    static void enable() { clear(DDRC, DDC3); }
    static bool reads_low() { return !is_set(PINC, PINC3); }
    static void compare(uint16_t count) { OCR2B = static_cast<uint8_t>(count); }
    static void connect() { set(TCCR2A, COM2B1); }
    static void disconnect() { clear(TCCR2A, COM2B1); }
};

// Of one bridge: its direction, and for how long it has been released or without drive, ms.
struct Condition {
    bool is_backward = false;
    bool is_enabled = false;
    bool has_risen = false;
    uint16_t without_drive = 0;
};

Condition conditions[coil_count];

// A compare value takes effect at the timer's next turn, up to 50 us later; at zero the pin is cut off from the timer,
// since fast PWM would still give a spike at compare value 0.
template <class Bridge>
void zero_one() {
    Bridge::disconnect();
    Bridge::compare(0);
}

template <class Bridge>
void turn(Condition& condition, bool is_backward) {
    Bridge::disconnect();  // the PWM pin is low while the direction changes
    if (is_backward) {
        Bridge::backward();
    } else {
        Bridge::forward();
    }
    condition.is_backward = is_backward;
}

template <class Bridge>
void drive_one(Condition& condition, int16_t duty) {
    condition.has_risen = condition.is_enabled;
    condition.is_enabled = true;
    condition.without_drive = 0;
    Bridge::enable();
    if (duty == 0) {
        zero_one<Bridge>();
        return;
    }
    const bool is_backward = duty < 0;
    if (is_backward != condition.is_backward) {
        turn<Bridge>(condition, is_backward);
    }
    Bridge::compare(static_cast<uint16_t>((is_backward ? -duty : duty) - 1));
    Bridge::connect();
}

// A coil of 125 mH holds 4 J at 8 A. Opened, the bridge would pump them into the supply's capacitors and past the
// driver's 41 V; with PWM low and one high side on, the current circles through bridge and coil and dies with L/R.
template <class Bridge>
void settle_one(Condition& condition, uint16_t counts) {
    condition.has_risen = false;
    if (!condition.is_enabled) {
        return;
    }
    ++condition.without_drive;
    const bool is_quiet = counts <= quiet_counts && condition.without_drive >= shortest_decay;
    if (is_quiet || condition.without_drive >= longest_decay) {
        Bridge::disable();
        condition.is_enabled = false;
    }
}

template <class Bridge>
bool has_fault(const Condition& condition) {
    return condition.has_risen && Bridge::reads_low();
}

template <class Bridge>
void begin_one() {
    Bridge::disable();  // the port's bit is 0: the line goes low
    Bridge::begin();
    Bridge::forward();
}

}  // namespace

void begin() {
    begin_one<Bridge1>();
    begin_one<Bridge2>();
    begin_one<Bridge3>();
    // Timer 1, mode 14: 16 MHz / 800 = 20 kHz. Timer 2, mode 7: 16 MHz / 8 / 100 = 20 kHz.
    ICR1 = pwm_steps[0] - 1;
    TCCR1A = bit(WGM11);
    TCCR1B = bit(WGM13) | bit(WGM12) | bit(CS10);
    OCR2A = pwm_steps[2] - 1;
    TCCR2A = bit(WGM21) | bit(WGM20);
    TCCR2B = bit(WGM22) | bit(CS21);
}

void drive(const CoilDrive& coils) {
    drive_one<Bridge1>(conditions[0], coils.duty(0));
    drive_one<Bridge2>(conditions[1], coils.duty(1));
    drive_one<Bridge3>(conditions[2], coils.duty(2));
}

void zero() {
    zero_one<Bridge1>();
    zero_one<Bridge2>();
    zero_one<Bridge3>();
}

void settle(const uint16_t* counts) {
    zero();
    settle_one<Bridge1>(conditions[0], counts[0]);
    settle_one<Bridge2>(conditions[1], counts[1]);
    settle_one<Bridge3>(conditions[2], counts[2]);
}

bool has_driver_fault() {
    return has_fault<Bridge1>(conditions[0]) || has_fault<Bridge2>(conditions[1]) ||
           has_fault<Bridge3>(conditions[2]);
}

}  // namespace bridges
}  // namespace pivotrig
