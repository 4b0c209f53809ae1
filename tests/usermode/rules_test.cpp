// SPDX-License-Identifier: GPL-2.0-or-later
// "What may be called where" (phantom_servo.h): each rule, broken, ends the process and says which it was.
#include <gtest/gtest.h>

#include "rules.h"

namespace phantom::test {
namespace {

struct Rule {
    const char* name;
    void (*breaks)();
    const char* says;
};

class RulesDeathTest : public ::testing::TestWithParam<Rule> {
  protected:
    // a child that runs this one test from the start: no lock or thread of this process comes along
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_P(RulesDeathTest, BrokenIsTheEnd)
{
    EXPECT_DEATH(GetParam().breaks(), GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(
    Contexts, RulesDeathTest,
    ::testing::Values(
        Rule{"Control", rules_break_control, "phantom_context_control.*lockdep_is_held"},
        Rule{"ControlHeldByAnother", rules_break_control_held_by_another,
             "phantom_context_control.*lockdep_is_held"},
        Rule{"Submitter", rules_break_submitter, "phantom_set_forget.*submitting"},
        Rule{"File", rules_break_file, "phantom_context_file.*control"},
        Rule{"Servo", rules_break_servo, "phantom_context_servo.*current"},
        Rule{"ServoWithControl", rules_break_servo_with_control, "phantom_servo_run.*control"},
        Rule{"Run", rules_break_run, "phantom_context_run"},
        Rule{"Section", rules_break_section, "phantom_context_section"},
        Rule{"SleepInSection", rules_break_sleep_in_section, "phantom_context_file.* inside a float section"},
        Rule{"NestedSection", rules_break_nested_section, "kernel_fpu_begin.* inside a float section"},
        Rule{"SectionOpenedInSection", rules_break_section_opened_in_section,
             "phantom_context_servo.*in_section"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Rules, KeptDisturbNobody)
{
    EXPECT_EQ(rules_kept(), 0);
}

} // namespace
} // namespace phantom::test
