/* SPDX-License-Identifier: GPL-2.0-or-later */
/*
 * recording_format.h - a recording (.rec): what the ticks of a servo were computed from, and what came out.
 *
 *     file      = recording...                       one behind the other
 *     recording = struct recording_header, chunk...  END is the last chunk
 *     chunk     = struct recording_chunk, payload    `size` bytes, a multiple of 8
 *
 *     ORIGIN  first, once: struct recording_origin
 *     START   struct recording_start: a START that succeeded. A run: the ticks from start_ns to the
 *             next START
 *     SET     struct phantom_set, its patches, materials, effect tables, objects: a SUBMIT_SET, before
 *             the first tick that has its id. Of two with an id the later counts: the first was
 *             refused. Its pointers mean nothing
 *     TICKS   struct phantom_tick, one or more, in the order of read()
 *     MARK    struct recording_mark: what the status page says of a run, now and then. A run that has
 *             fewer records up to `tick` than tick - missed has lost some
 *     END     struct recording_end: the recorder ended as it should
 *
 * SET_MODEL, SET_RATE, STOP, CLEAR_FAULT, errors and positions of the device stand in the ticks that they
 * came to (phantom_abi.h). A recorder that is not the feeder knows neither starts nor sets and does not set
 * RECORDING_FED: such a recording can be read, not computed again.
 *
 * Little endian, structures as they lie in memory; their sizes and version are those of phantom_abi.h that
 * origin.info names. An unknown kind is skipped. A file that ends in the middle, or from some place on has
 * wrong checksums, is good up to there. C and C++.
 */
#ifndef PHANTOM_RECORDING_FORMAT_H
#define PHANTOM_RECORDING_FORMAT_H

#include <stddef.h>

#include "phantom_abi.h"

#define RECORDING_MAGIC "PHANTREC" /* without its 0 */
#define RECORDING_VERSION 2

/* Payloads are no larger; a set with all it may carry in the kernel has 64 KiB. */
#define RECORDING_CHUNK_MAX (1U << 30)

#define RECORDING_ORIGIN 1
#define RECORDING_START 2
#define RECORDING_SET 3
#define RECORDING_TICKS 4
#define RECORDING_MARK 5
#define RECORDING_END 6

struct recording_header {
    char magic[8];
    __u32 version; /* RECORDING_VERSION */
    __u32 reserved;
};

struct recording_chunk {
    __u32 kind;     /* RECORDING_... */
    __u32 size;     /* of the payload, bytes */
    __u32 checksum; /* recording_checksum() of kind and size, then of the payload */
    __u32 reserved;
};

#define RECORDING_FED (1U << 0) /* starts and sets are in it */
struct recording_origin {
    struct phantom_info info;
    __u32 isa;       /* PHANTOM_ISA_... of the module */
    __u32 flags;     /* RECORDING_FED */
    char device[64]; /* its name, ended by 0 */
    char scene[256]; /* what was touched, ended by 0; may be empty */
};

struct recording_start {
    __u64 start_ns; /* status.start_ns when START returned: no tick of the run is before it */
    struct phantom_start start;
};

struct recording_mark {
    __u64 start_ns; /* of status: when the run began */
    __u64 tick;
    __u64 missed;
};

struct recording_end {
    __u64 ticks; /* records written */
    __u64 sets;
};

/* CRC-32 (as zlib's); begin with 0, go on with what the call before gave. */
static inline __u32 recording_checksum(__u32 checksum, const void* data, size_t size)
{
    static const __u32 table[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
                                    0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                    0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
    const unsigned char* byte = (const unsigned char*)data;
    const unsigned char* end = byte + size;

    checksum = ~checksum;
    for (; byte != end; byte++) {
        checksum = table[(checksum ^ *byte) & 15] ^ (checksum >> 4);
        checksum = table[(checksum ^ (*byte >> 4)) & 15] ^ (checksum >> 4);
    }
    return ~checksum;
}

#endif /* PHANTOM_RECORDING_FORMAT_H */
