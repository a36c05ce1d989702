// Written by `python -m control.firmware.contract` from the host's definitions: change those, not this.
#ifndef PIVOTRIG_CONTRACT_H
#define PIVOTRIG_CONTRACT_H

#include <stdint.h>

#include "flash.h"

namespace pivotrig {

constexpr uint8_t protocol_version = 1;
constexpr uint8_t firmware_major = 0;
constexpr uint8_t firmware_minor = 1;
constexpr uint8_t firmware_patch = 0;
constexpr uint16_t sequence_window = 1000;
constexpr uint8_t longest_frame = 64;
constexpr uint8_t transmit_buffer = 255;
constexpr uint8_t telemetry_period = 10;
constexpr uint8_t arm = 1;
constexpr uint8_t allocation_bits = 14;
constexpr uint16_t sense_gain = 8929;
constexpr uint16_t full_count = 1023;
constexpr int16_t most_sensed = 32767;
constexpr int32_t integral_limit = 6144000;
constexpr uint8_t over_current_ticks = 3;
constexpr uint16_t quarter_turn = 16384;
constexpr uint16_t pwm_steps[3] = {800, 800, 100};
constexpr uint16_t duty_scale[3] = {5242, 5242, 41943};

enum class Code : uint8_t {
    Hello = 1,
    Banner = 2,
    Configure = 3,
    Drive = 4,
    Stop = 5,
    Telemetry = 6,
};

enum class BoardCode : uint8_t {
    Booted = 0,
    Ready = 1,
    Driving = 2,
    Expired = 3,
    Stopped = 4,
    Fault = 5,
};

enum class Refusal : uint8_t {
    None = 0,
    Version = 1,
    BootId = 2,
    Sequence = 3,
    State = 4,
    Flags = 5,
    Pivot = 6,
    Rate = 7,
    Tilt = 8,
    Field = 9,
    Lifetime = 10,
    Configuration = 11,
    Direction = 12,
};

enum class ResetCause : uint8_t {
    Unknown = 0,
    PowerOn = 1,
    External = 2,
    BrownOut = 3,
    Watchdog = 4,
};

constexpr uint16_t over_current_flag = 1;
constexpr uint16_t driver_fault_flag = 2;
constexpr uint16_t supply_low_flag = 4;
constexpr uint16_t saturated_flag = 8;
constexpr uint16_t supply_assumed_flag = 16;

constexpr uint8_t hello_length = 0;

constexpr uint8_t banner_length = 6;
struct __attribute__((packed)) Banner {
    uint8_t firmware[3];
    uint8_t reset_cause;
    uint16_t configuration_hash;
};
static_assert(sizeof(Banner) == banner_length, "lies as on the wire");

constexpr uint8_t configure_length = 48;
struct __attribute__((packed)) Configure {
    uint16_t current_limits[3];
    uint16_t dead_man;
    uint16_t ramp;
    uint16_t field_slew;
    uint16_t resistances[3];
    uint16_t inductances[3];
    uint16_t supply;
    uint16_t max_field;
    uint32_t max_rate;
    uint16_t max_tilt;
    uint16_t sense_gains[6];
    uint16_t supply_scale;
};
static_assert(sizeof(Configure) == configure_length, "lies as on the wire");

constexpr uint8_t drive_length = 38;
struct __attribute__((packed)) Drive {
    uint8_t flags;
    int8_t pivot;
    int32_t rate;
    uint32_t heading_goal;
    uint32_t start_heading;
    uint16_t tilt;
    uint16_t field;
    int16_t allocation[9];
    uint16_t time_to_live;
};
static_assert(sizeof(Drive) == drive_length, "lies as on the wire");

constexpr uint8_t stop_length = 0;

constexpr uint8_t telemetry_length = 46;
struct __attribute__((packed)) Telemetry {
    uint32_t time;
    uint32_t heading;
    int16_t elevation;
    int16_t commanded[3];
    int16_t measured[3];
    int16_t duty[3];
    uint16_t supply;
    uint8_t state;
    uint16_t flags;
    uint16_t last_sequence;
    uint16_t good;
    uint16_t bad;
    uint16_t refused;
    uint16_t stale;
    uint8_t last_refusal;
    uint16_t configuration_hash;
};
static_assert(sizeof(Telemetry) == telemetry_length, "lies as on the wire");

struct Range {
    uint32_t low;
    uint32_t high;
};

// Within these no intermediate of the arithmetic leaves 32 bits.
namespace allowed {
constexpr Range current_limits = {1, 12000};
constexpr Range dead_man = {10, 500};
constexpr Range ramp = {1, 1000};
constexpr Range field_slew = {1, 65535};
constexpr Range resistances = {100, 10000};
constexpr Range inductances = {300, 16000};
constexpr Range supply = {5000, 50000};
constexpr Range max_field = {1, 32767};
constexpr Range max_rate = {1, 268435455};
constexpr Range max_tilt = {1, 10923};
constexpr Range sense_gains = {4464, 11161};
constexpr Range supply_scale = {0, 65000};
}

constexpr int16_t quarter_wave[257] PIVOTRIG_FLASH = {
    0, 201, 402, 603, 804, 1005, 1206, 1407, 1608, 1809, 2009, 2210,
    2410, 2611, 2811, 3012, 3212, 3412, 3612, 3811, 4011, 4210, 4410, 4609,
    4808, 5007, 5205, 5404, 5602, 5800, 5998, 6195, 6393, 6590, 6786, 6983,
    7179, 7375, 7571, 7767, 7962, 8157, 8351, 8545, 8739, 8933, 9126, 9319,
    9512, 9704, 9896, 10087, 10278, 10469, 10659, 10849, 11039, 11228, 11417, 11605,
    11793, 11980, 12167, 12353, 12539, 12725, 12910, 13094, 13279, 13462, 13645, 13828,
    14010, 14191, 14372, 14553, 14732, 14912, 15090, 15269, 15446, 15623, 15800, 15976,
    16151, 16325, 16499, 16673, 16846, 17018, 17189, 17360, 17530, 17700, 17869, 18037,
    18204, 18371, 18537, 18703, 18868, 19032, 19195, 19357, 19519, 19680, 19841, 20000,
    20159, 20317, 20475, 20631, 20787, 20942, 21096, 21250, 21403, 21554, 21705, 21856,
    22005, 22154, 22301, 22448, 22594, 22739, 22884, 23027, 23170, 23311, 23452, 23592,
    23731, 23870, 24007, 24143, 24279, 24413, 24547, 24680, 24811, 24942, 25072, 25201,
    25329, 25456, 25582, 25708, 25832, 25955, 26077, 26198, 26319, 26438, 26556, 26674,
    26790, 26905, 27019, 27133, 27245, 27356, 27466, 27575, 27683, 27790, 27896, 28001,
    28105, 28208, 28310, 28411, 28510, 28609, 28706, 28803, 28898, 28992, 29085, 29177,
    29268, 29358, 29447, 29534, 29621, 29706, 29791, 29874, 29956, 30037, 30117, 30195,
    30273, 30349, 30424, 30498, 30571, 30643, 30714, 30783, 30852, 30919, 30985, 31050,
    31113, 31176, 31237, 31297, 31356, 31414, 31470, 31526, 31580, 31633, 31685, 31736,
    31785, 31833, 31880, 31926, 31971, 32014, 32057, 32098, 32137, 32176, 32213, 32250,
    32285, 32318, 32351, 32382, 32412, 32441, 32469, 32495, 32521, 32545, 32567, 32589,
    32609, 32628, 32646, 32663, 32678, 32692, 32705, 32717, 32728, 32737, 32745, 32752,
    32757, 32761, 32765, 32766, 32767,
};

}  // namespace pivotrig

#endif
