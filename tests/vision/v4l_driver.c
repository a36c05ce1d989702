/* A V4L camera driver without a kernel: preloaded into a process, it answers in place of the device /dev/full, which
 * every Linux has and nobody reads pictures from. The file named by V4L_DRIVER says how it behaves, and may be
 * changed while it runs: eight 32-bit integers, see `Behaviour`. OpenCV and pivotrig are as they are.
 *
 * Pictures are YUYV of one grey level, 16 + (number of the frame modulo 200). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#define DEVICE "/dev/full"
#define BUFFERS 4
#define MOST_DESCRIPTORS 1024

struct Behaviour {
    int32_t present;      /* 0: unplugged; 2: may be opened once at a time */
    int32_t hangs;        /* 1: whoever waits for a picture waits for ever */
    int32_t width;        /* the only size that it offers, px */
    int32_t height;
    int32_t rate;         /* the only rate, frames/s */
    int32_t clock;        /* stamps: 0 monotonic, 1 the time of day, 2 none, 3 monotonic of 3 s ago */
    int32_t age_ms;       /* pictures have waited for so long before they can be had */
    int32_t longest_exposure; /* in 100 us; 0: no such control */
};

static char ours[MOST_DESCRIPTORS];
static uint32_t exposure = 50, automatic = 3;
static uint32_t queued;
static int64_t started, last_frame;

static struct Behaviour behaviour(void) {
    struct Behaviour read_in = {0};
    int (*real_open)(const char *, int, ...) = dlsym(RTLD_NEXT, "open");
    int file = real_open(getenv("V4L_DRIVER"), O_RDONLY | O_CLOEXEC);
    if (file >= 0) {
        if (pread(file, &read_in, sizeof read_in, 0) != sizeof read_in) read_in.present = 0;
        int (*real_close)(int) = dlsym(RTLD_NEXT, "close");
        real_close(file);
    }
    return read_in;
}

static int64_t microseconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return now.tv_sec * 1000000LL + now.tv_nsec / 1000;
}

static int fail(int number) {
    errno = number;
    return -1;
}

/* Of one picture in memory: whole pages, which can be mapped one by one. */
static off_t stride(struct Behaviour is) {
    return (2 * is.width * is.height + 4095) / 4096 * 4096;
}

static int open_device(void) {
    struct Behaviour is = behaviour();
    if (!is.present) return fail(ENODEV);
    if (is.present == 2 && memchr(ours, 1, sizeof ours)) return fail(EBUSY);
    int memory = memfd_create("v4l", MFD_CLOEXEC);
    if (memory < 0 || ftruncate(memory, BUFFERS * stride(is)) < 0) return -1;
    ours[memory] = 1;
    return memory;
}

static void describe(struct v4l2_format *format) {
    struct Behaviour is = behaviour();
    format->fmt.pix.width = is.width;
    format->fmt.pix.height = is.height;
    format->fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
    format->fmt.pix.field = V4L2_FIELD_NONE;
    format->fmt.pix.bytesperline = 2 * is.width;
    format->fmt.pix.sizeimage = 2 * is.width * is.height;
}

static int next_picture(int memory, struct v4l2_buffer *buffer) {
    struct Behaviour is;
    int64_t period, due;
    do {
        is = behaviour();
        if (!is.present) return fail(ENODEV);
        period = 1000000LL / is.rate;
        int64_t newest = (microseconds(CLOCK_MONOTONIC) - started) / period;
        int64_t oldest_kept = newest - __builtin_popcount(queued) + 1;
        int64_t number = last_frame + 1 > oldest_kept ? last_frame + 1 : oldest_kept;
        due = started + number * period + is.age_ms * 1000LL;
        if (!is.hangs && microseconds(CLOCK_MONOTONIC) >= due) {
            last_frame = number;
            break;
        }
        usleep(500);
    } while (1);
    uint32_t index = __builtin_ctz(queued ? queued : 1);
    queued &= ~(1u << index);
    uint32_t size = 2 * is.width * is.height;
    uint8_t *pixels = mmap(NULL, size, PROT_WRITE, MAP_SHARED, memory, index * stride(is));
    if (pixels == MAP_FAILED) return -1;
    for (uint32_t byte = 0; byte < size; byte++) pixels[byte] = byte % 2 ? 128 : 16 + last_frame % 200;
    munmap(pixels, size);
    int64_t stamp = started + last_frame * period;
    if (is.clock == 1) stamp += microseconds(CLOCK_REALTIME) - microseconds(CLOCK_MONOTONIC);
    if (is.clock == 2) stamp = 0;
    if (is.clock == 3) stamp -= 3000000LL;
    buffer->index = index;
    buffer->bytesused = buffer->length = size;
    buffer->flags = V4L2_BUF_FLAG_MAPPED | V4L2_BUF_FLAG_DONE;
    buffer->sequence = last_frame;
    buffer->timestamp.tv_sec = stamp / 1000000;
    buffer->timestamp.tv_usec = stamp % 1000000;
    return 0;
}

static int range_of(struct v4l2_queryctrl *control) {
    struct Behaviour is = behaviour();
    if (control->id != V4L2_CID_EXPOSURE_ABSOLUTE || !is.longest_exposure) return fail(EINVAL);
    control->minimum = 1;
    control->maximum = is.longest_exposure;
    control->step = 1;
    control->flags = 0;
    return 0;
}

static int control(struct v4l2_control *asked, int set) {
    uint32_t *value = asked->id == V4L2_CID_EXPOSURE_ABSOLUTE && behaviour().longest_exposure ? &exposure
                      : asked->id == V4L2_CID_EXPOSURE_AUTO                                   ? &automatic
                                                                                              : NULL;
    if (!value) return fail(EINVAL);
    if (set && value == &exposure && automatic != V4L2_EXPOSURE_MANUAL) return fail(EACCES);
    if (set) *value = asked->value;
    asked->value = *value;
    return 0;
}

static int answer(int memory, unsigned long request, void *argument) {
    struct Behaviour is = behaviour();
    if (!is.present) return fail(ENODEV);
    uint32_t size = 2 * is.width * is.height;
    switch (request) {
    case VIDIOC_QUERYCAP: {
        struct v4l2_capability *capability = argument;
        memset(capability, 0, sizeof *capability);
        strcpy((char *)capability->driver, "without kernel");
        capability->capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_DEVICE_CAPS;
        capability->device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
    }
    case VIDIOC_ENUM_FMT: {
        struct v4l2_fmtdesc *format = argument;
        if (format->index) return fail(EINVAL);
        format->pixelformat = V4L2_PIX_FMT_YUYV;
        return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
        struct v4l2_frmsizeenum *sizes = argument;
        if (sizes->index) return fail(EINVAL);
        sizes->type = V4L2_FRMSIZE_TYPE_DISCRETE;
        sizes->discrete.width = is.width;
        sizes->discrete.height = is.height;
        return 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
        struct v4l2_frmivalenum *interval = argument;
        if (interval->index) return fail(EINVAL);
        interval->type = V4L2_FRMIVAL_TYPE_DISCRETE;
        interval->discrete.numerator = 1;
        interval->discrete.denominator = is.rate;
        return 0;
    }
    case VIDIOC_S_FMT:
    case VIDIOC_G_FMT: describe(argument); return 0;
    case VIDIOC_S_PARM:
    case VIDIOC_G_PARM: {
        struct v4l2_streamparm *parameters = argument;
        parameters->parm.capture.timeperframe.numerator = 1;
        parameters->parm.capture.timeperframe.denominator = is.rate;
        return 0;
    }
    case VIDIOC_REQBUFS: {
        struct v4l2_requestbuffers *wanted = argument;
        if (wanted->count > BUFFERS) wanted->count = BUFFERS;
        queued = 0;
        return 0;
    }
    case VIDIOC_QUERYBUF: {
        struct v4l2_buffer *buffer = argument;
        buffer->length = size;
        buffer->m.offset = buffer->index * stride(is);
        return 0;
    }
    case VIDIOC_QBUF: queued |= 1u << ((struct v4l2_buffer *)argument)->index; return 0;
    case VIDIOC_DQBUF: return next_picture(memory, argument);
    case VIDIOC_STREAMON:
        started = microseconds(CLOCK_MONOTONIC);
        last_frame = 0;
        return 0;
    case VIDIOC_STREAMOFF: return 0;
    case VIDIOC_QUERYCTRL: return range_of(argument);
    case VIDIOC_G_CTRL: return control(argument, 0);
    case VIDIOC_S_CTRL: return control(argument, 1);
    default: return fail(ENOTTY);
    }
}

int ioctl(int descriptor, unsigned long request, ...) {
    va_list arguments;
    va_start(arguments, request);
    void *argument = va_arg(arguments, void *);
    va_end(arguments);
    if (descriptor >= 0 && descriptor < MOST_DESCRIPTORS && ours[descriptor])
        return answer(descriptor, (uint32_t)request, argument);
    int (*real)(int, unsigned long, void *) = dlsym(RTLD_NEXT, "ioctl");
    return real(descriptor, request, argument);
}

static int open_any(const char *name, const char *path, int flags, mode_t mode) {
    if (path && !strcmp(path, DEVICE)) return open_device();
    int (*real)(const char *, int, ...) = dlsym(RTLD_NEXT, name);
    return real(path, flags, mode);
}

#define OPEN(NAME)                                              \
    int NAME(const char *path, int flags, ...) {                \
        va_list arguments;                                      \
        va_start(arguments, flags);                             \
        mode_t mode = va_arg(arguments, mode_t);                \
        va_end(arguments);                                      \
        return open_any(#NAME, path, flags, mode);              \
    }
OPEN(open)
OPEN(open64)

int close(int descriptor) {
    if (descriptor >= 0 && descriptor < MOST_DESCRIPTORS) ours[descriptor] = 0;
    int (*real)(int) = dlsym(RTLD_NEXT, "close");
    return real(descriptor);
}
