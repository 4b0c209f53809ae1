// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/servo_switch.hpp"

namespace phantom::view {

Status ServoSwitch::toggle()
{
    device::Device& device = session_.device();
    if (!off_) {
        model_ = device.status().model;
        phantom_model none = model_;
        none.model = PHANTOM_MODEL_OFF;
        Status faded = device.set_model(none);
        Status stopped = device.stop(); // also when the fade was refused
        off_ = stopped.ok();
        return faded ? stopped : faded;
    }
    if (Status set = device.set_model(model_); !set)
        return set;
    Status started = device.start(session_.start_request());
    off_ = !started.ok();
    return started;
}

} // namespace phantom::view
