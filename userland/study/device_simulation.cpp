// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/device_simulation.hpp"

namespace phantom::study {

namespace {

constexpr double mm_per_m = 1e3, ms_per_s = 1e3;

Arm arm_of(const scene::DeviceSettings& device, const Vec3& at_mm)
{
    Arm arm;
    arm.mass_kg = device.mass_kg.value_or(arm.mass_kg);
    arm.viscous_ns_mm = device.damping_ns_m.value_or(0) / mm_per_m;
    arm.coulomb_n = device.friction_n.value_or(0);
    arm.step_mm = device.encoder_mm.value_or(0);
    arm.at = at_mm;
    return arm;
}

Actuator actuator_of(const scene::DeviceSettings& device)
{
    const scene::AmplifierSettings amplifier = device.amplifier.value_or(scene::AmplifierSettings{});
    Actuator actuator;
    actuator.delay_s = device.delay_ms.value_or(0) / ms_per_s;
    actuator.max_force_n = amplifier.max_force_n.value_or(0);
    actuator.bandwidth_hz = amplifier.bandwidth_hz.value_or(0);
    return actuator;
}

} // namespace

DeviceSimulation::DeviceSimulation(const scene::DeviceSettings& device, const Vec3& at_mm)
    : arm_(arm_of(device, at_mm)), actuator_(actuator_of(device))
{
    if (device.hand) {
        hand_.emplace();
        hand_->spring_n_mm = device.hand->stiffness_n_mm;
        hand_->damper_ns_mm = device.hand->damping_ns_m / mm_per_m;
        hand_->mass_kg = device.hand->mass_kg;
        hand_->target = at_mm;
    }
}

Vec3 DeviceSimulation::read(const Vec3& led_mm) const
{
    return hand_ ? arm_.read() : Arm::stepped(led_mm, arm_.step_mm);
}

void DeviceSimulation::pass(const Vec3& force_n, const Vec3& from_mm, const Vec3& to_mm, double period_s)
{
    if (!hand_)
        return;
    hand_->target = from_mm;
    hand_->target_velocity = (1 / period_s) * (to_mm - from_mm);
    work_n_mm_ += pass_period(arm_, *hand_, actuator_, force_n, period_s);
}

double DeviceSimulation::energy_n_mm() const
{
    if (!hand_)
        return 0;
    const Vec3 stretch = hand_->target - arm_.at;
    // kg mm^2/s^2 are 1e-3 N mm
    return 0.5e-3 * (arm_.mass_kg + hand_->mass_kg) * dot(arm_.velocity, arm_.velocity) +
           0.5 * hand_->spring_n_mm * dot(stretch, stretch);
}

} // namespace phantom::study
