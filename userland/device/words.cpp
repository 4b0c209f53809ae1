// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers of phantom_abi.h to words and back.
#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "device/device.hpp"

namespace phantom::device {

namespace {

struct Word {
    const char* text;
    std::uint32_t number;
};

constexpr Word models[] = {
    {"paper", PHANTOM_MODEL_PAPER}, {"projected", PHANTOM_MODEL_PROJECTED}, {"off", PHANTOM_MODEL_OFF}};
constexpr Word combinations[] = {{"paper", PHANTOM_COMBINE_PAPER}, {"bounded", PHANTOM_COMBINE_BOUNDED}};
constexpr Word proxies[] = {
    {"paper", PHANTOM_PROXY_PAPER}, {"constrained", PHANTOM_PROXY_CONSTRAINED}, {"off", PHANTOM_PROXY_OFF}};
constexpr Word ariths[] = {
    {"float", PHANTOM_ARITH_FLOAT}, {"fixed", PHANTOM_ARITH_FIXED}, {"double", PHANTOM_ARITH_DOUBLE}};
constexpr Word faults[] = {{"device", PHANTOM_FAULT_DEVICE},       {"overspeed", PHANTOM_FAULT_OVERSPEED},
                           {"stall", PHANTOM_FAULT_STALL},         {"numeric", PHANTOM_FAULT_NUMERIC},
                           {"unplugged", PHANTOM_FAULT_UNPLUGGED}, {"suspended", PHANTOM_FAULT_SUSPENDED}};

Result<std::uint32_t> number_of(const char* what, const std::string& text, std::span<const Word> words)
{
    std::string known;
    for (const Word& word : words) {
        if (text == word.text)
            return word.number;
        known += (known.empty() ? "" : ", ") + std::string(word.text);
    }
    return Error{"", fmt::format("{} '{}': expected one of {}", what, text, known)};
}

const char* text_of(std::uint32_t number, std::span<const Word> words)
{
    for (const Word& word : words)
        if (word.number == number)
            return word.text;
    return "unknown";
}

} // namespace

const char* state_name(std::uint32_t state)
{
    constexpr Word states[] = {
        {"IDLE", PHANTOM_STATE_IDLE}, {"RUNNING", PHANTOM_STATE_RUNNING}, {"FAULT", PHANTOM_STATE_FAULT}};
    return text_of(state, states);
}

const char* isa_name(std::uint32_t isa)
{
    constexpr Word isas[] = {{"none", PHANTOM_ISA_NONE},     {"sse2", PHANTOM_ISA_SSE2},
                             {"avx2", PHANTOM_ISA_AVX2},     {"avx512", PHANTOM_ISA_AVX512},
                             {"double", PHANTOM_ISA_DOUBLE}, {"fixed", PHANTOM_ISA_FIXED}};
    return text_of(isa, isas);
}

const char* device_name(std::uint32_t device)
{
    constexpr Word devices[] = {{"none", PHANTOM_DEVICE_NONE},
                                {"simulated", PHANTOM_DEVICE_SIM},
                                {"HID", PHANTOM_DEVICE_HID},
                                {"PCI", PHANTOM_DEVICE_PCI}};
    return text_of(device, devices);
}

std::string fault_names(std::uint32_t mask)
{
    std::string names;
    for (const Word& fault : faults)
        if (mask & fault.number)
            names += (names.empty() ? "" : ", ") + std::string(fault.text);
    return names.empty() ? "none" : names;
}

std::string model_text(const phantom_model& model)
{
    if (model.model == PHANTOM_MODEL_OFF)
        return "off";
    std::string text = text_of(model.model, models);
    if (model.model == PHANTOM_MODEL_PROJECTED)
        text += fmt::format(", {} Newton step{}", model.newton_steps, model.newton_steps == 1 ? "" : "s");
    return text + fmt::format(", combine {}, proxy {}, arith {}", text_of(model.combine, combinations),
                              text_of(model.proxy, proxies), text_of(model.arith, ariths));
}

Result<phantom_model> model_from_words(const std::string& model, const std::string& combine,
                                       const std::string& proxy, const std::string& arith, int steps)
{
    phantom_model out{};
    struct Field {
        const char* what;
        const std::string& text;
        std::span<const Word> words;
        __u32* number;
    };
    const Field fields[] = {{"model", model, models, &out.model},
                            {"combination", combine, combinations, &out.combine},
                            {"proxy", proxy, proxies, &out.proxy},
                            {"arithmetic", arith, ariths, &out.arith}};
    for (const Field& field : fields) {
        Result<std::uint32_t> number = number_of(field.what, field.text, field.words);
        if (!number)
            return number.error();
        *field.number = *number;
    }
    if (steps < 0 || steps > PHANTOM_NEWTON_STEPS_MAX)
        return Error{"", fmt::format("Newton steps {}: expected 0 to {}", steps, PHANTOM_NEWTON_STEPS_MAX)};
    out.newton_steps = static_cast<__u32>(steps);
    return out;
}

} // namespace phantom::device
