#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-2.0-or-later
# A tick of contact alone, in a build that has every effect, takes the instructions of one that has none, to half
# a per cent: of both models, in SSE2 and AVX2.
#
#   contact_alone_test.sh TICK_INSTRUCTIONS EFFECT_BENCH
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$2" contact | tee "$folder/table"
awk '
    $1 == "contact" {
        bare = $3 == "bare"
        for (i = 3 + bare; i < NF; i += 2)
            count[$2, $i, bare] = $(i + 1)
        if (!bare) for (i = 3; i < NF; i += 2) figures[$2 "|" $i]
    }
    END {
        for (figure in figures) {
            split(figure, part, "|")
            with = count[part[1], part[2], 0]; without = count[part[1], part[2], 1]
            if (!without) continue
            compared++
            printf "%s %s: %d, without effects %d: %+.2f %%\n", part[1], part[2], with, without,
                100 * (with - without) / without
            if (with > 1.005 * without || with < 0.995 * without) wrong++
        }
        if (compared != 4) print "expected two models in SSE2 and AVX2, found " compared
        exit wrong || compared != 4
    }' "$folder/table"
