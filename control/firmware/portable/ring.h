// A queue of bytes between one writer and one reader, of which one may be an interrupt.
#ifndef PIVOTRIG_RING_H
#define PIVOTRIG_RING_H

#include <stdint.h>

namespace pivotrig {

// Holds up to SIZE - 1 bytes; SIZE is a power of two up to 256. The writer owns head, the reader owns tail; both are
// single bytes, so each side reads the other's in one instruction.
template <uint16_t SIZE>
class Ring {
 public:
    static_assert(SIZE <= 256 && (SIZE & (SIZE - 1)) == 0, "a power of two up to 256");

    bool is_empty() const { return head_ == tail_; }

    uint8_t room() const { return static_cast<uint8_t>((tail_ - head_ - 1) & mask); }

    // To be called with room only.
    void push(uint8_t byte) {
        const uint8_t head = head_;
        data_[head] = byte;
        head_ = static_cast<uint8_t>((head + 1) & mask);
    }

    // To be called on a ring that is not empty only.
    uint8_t pop() {
        const uint8_t tail = tail_;
        const uint8_t byte = data_[tail];
        tail_ = static_cast<uint8_t>((tail + 1) & mask);
        return byte;
    }

 private:
    static constexpr uint8_t mask = static_cast<uint8_t>(SIZE - 1);
    volatile uint8_t head_ = 0;
    volatile uint8_t tail_ = 0;
    volatile uint8_t data_[SIZE] = {};
};

}  // namespace pivotrig

#endif
