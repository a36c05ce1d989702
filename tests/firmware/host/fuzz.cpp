// Feeds whatever comes on standard input to the firmware's core, 50 bytes and one tick at a time as on the wire, and
// prints what is left: the state's number, the PWM steps, and how many ticks drove.
#include <stdio.h>

#include "../../../control/firmware/portable/board.h"

int main() {
    pivotrig::Board board;
    board.boot(7, pivotrig::ResetCause::PowerOn);
    uint8_t data[50];
    uint16_t noise = 0;
    unsigned long driven = 0;
    for (size_t size; (size = fread(data, 1, sizeof data, stdin)) != 0;) {
        for (size_t place = 0; place < size; ++place) {
            board.receive(data[place]);
        }
        noise = static_cast<uint16_t>(noise * 25173u + 13849u);
        const uint16_t counts = noise >> 8;
        board.tick({{counts, static_cast<uint16_t>(counts >> 3), static_cast<uint16_t>(counts >> 5)}, counts, false});
        if (board.has_report()) {
            board.report();
        }
        while (!board.outbox().is_empty()) {
            board.outbox().pop();
        }
        driven += board.is_driving();
    }
    const pivotrig::CoilDrive& coils = board.coils();
    printf("%d %d %d %d %lu\n", static_cast<int>(board.state()), coils.duty(0), coils.duty(1), coils.duty(2), driven);
    return 0;
}
