// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_trace.c - makes the events that phantom_trace.h declares.
 */
#include <phantom_platform.h>

#define CREATE_TRACE_POINTS
#include <phantom_trace.h>
