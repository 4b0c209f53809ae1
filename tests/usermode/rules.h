/* SPDX-License-Identifier: GPL-2.0-or-later */
/*
 * rules.h - every context rule of phantom_servo.h, broken once. Each function is expected to end the
 * process; 0 from the first one says that a servo used by the rules is left alone.
 */
#ifndef PHANTOM_TEST_RULES_H
#define PHANTOM_TEST_RULES_H

#ifdef __cplusplus
extern "C" {
#endif

int rules_kept(void);

void rules_break_control(void);
void rules_break_control_held_by_another(void);
void rules_break_submitter(void);
void rules_break_file(void);
void rules_break_servo(void);
void rules_break_servo_with_control(void);
void rules_break_run(void);
void rules_break_section(void);
void rules_break_sleep_in_section(void);
void rules_break_nested_section(void);
void rules_break_section_opened_in_section(void);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_TEST_RULES_H */
