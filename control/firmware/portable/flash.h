// Tables that stay in the program memory of a microcontroller.
#ifndef PIVOTRIG_FLASH_H
#define PIVOTRIG_FLASH_H

#include <stdint.h>

#ifdef __AVR__
#include <avr/pgmspace.h>
#define PIVOTRIG_FLASH PROGMEM
#else
#define PIVOTRIG_FLASH
#endif

namespace pivotrig {

inline int16_t read_flash(const int16_t* place) {
#ifdef __AVR__
    return static_cast<int16_t>(pgm_read_word(place));
#else
    return *place;
#endif
}

}  // namespace pivotrig

#endif
