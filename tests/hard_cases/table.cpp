// SPDX-License-Identifier: GPL-2.0-or-later
// hard_cases_table: what every hard case did with every model and arithmetic.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "random_cases.hpp"
#include "suite.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

constexpr const char* usage = "usage: hard_cases_table [--markdown | --random SEED COUNT | --case WORD]\n"
                              "  --markdown            the short table, one row for each kind of case\n"
                              "  --random SEED COUNT   random cases instead of the named ones\n"
                              "  --case WORD           only cases whose name contains WORD\n";

/// Samples are so many times farther apart than in the case.
constexpr double table_coarseness = 0.25;

/// The figures of a row, as printed: rows that print alike are one.
std::string figures(const Measured& m)
{
    const auto step = [](double kr) { return kr > 0 ? fmt::format("{:.4f}", kr) : std::string("-"); };
    return fmt::format("{:9.4f} {:>8} {:>8} {:>8} {:>8} {:6} {:7} {:6} {:4} {:7}", m.force,
                       step(m.outside.step), step(m.outside.jump), step(m.inside.step), step(m.inside.jump),
                       m.gaps, m.doubles, m.fallen, m.not_numbers, m.refused);
}

Measured run_all_proxies(const Course& course, const Case& hard, const phantom_float_ops& ops,
                         const Variant& variant)
{
    Measured sum;
    for (const std::uint32_t proxy : proxies_of(hard))
        sum.add(course.run(ops, variant, proxy));
    return sum;
}

/// The rows of one case; returns how many promises were broken.
unsigned print_case(const Case& hard)
{
    const Course course(hard, table_coarseness);
    unsigned faults = 0;
    fmt::print("{} / {}{}{}{}{}\n", title(hard.kind), hard.name, hard.outcome.empty() ? "" : ": ",
               hard.outcome, hard.fault.empty() ? "" : "\n  KNOWN FAULT: ", hard.fault);
    for (const Variant& variant : variants) {
        std::vector<std::pair<std::string, std::string>> rows; // figures, arithmetics
        std::vector<std::string> sentences;
        for (const phantom_float_ops* ops : sections()) {
            const Measured m = run_all_proxies(course, hard, *ops, variant);
            for (const std::string& sentence : broken(hard, *ops, variant, m))
                sentences.push_back(fmt::format("    {}: {}", ops->name, sentence));
            const std::string text = figures(m);
            const auto same =
                std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.first == text; });
            if (same == rows.end())
                rows.emplace_back(text, ops->name);
            else
                same->second += std::string(" ") + ops->name;
        }
        for (const auto& [text, arithmetics] : rows)
            fmt::print("  {:20} {:18} {}\n", variant.name, rows.size() == 1 ? "all" : arithmetics, text);
        sentences.erase(std::unique(sentences.begin(), sentences.end()), sentences.end());
        for (const std::string& sentence : sentences)
            fmt::print("{}\n", sentence);
        faults += static_cast<unsigned>(sentences.size());
    }
    return faults;
}

/// What all cases of a kind did, for the short table.
struct Summary {
    unsigned cases = 0, refused = 0;
    double excess = 0;
    double promised = 0, elsewhere = 0; ///< step of `projected`, where one is promised and where not
    double paper = 0;
    std::uint64_t gaps = 0, doubles = 0, wrong = 0, not_numbers = 0;

    void add(const Case& hard, const Variant& variant, const Measured& m, bool fault)
    {
        excess = std::max(excess, hard.saturates ? 0 : m.excess);
        not_numbers += m.not_numbers;
        wrong += m.fallen;
        refused = std::max(refused, m.refused);
        if (variant.model == PHANTOM_MODEL_PAPER && variant.combine == PHANTOM_COMBINE_BOUNDED)
            paper = std::max(paper, m.outside.step);
        if (variant.model != PHANTOM_MODEL_PROJECTED || variant.newton_steps < exact_steps)
            return;
        double& step = hard.projected_step < measured && !fault ? promised : elsewhere;
        step = std::max(step, m.outside.step);
        gaps += m.gaps;
        doubles += hard.once ? m.doubles : 0;
    }
};

void print_markdown()
{
    std::map<Kind, Summary> kinds;
    Summary faults;
    for (const Case& hard : corpus()) {
        const Course course(hard, table_coarseness);
        kinds[hard.kind].cases += hard.fault.empty();
        faults.cases += !hard.fault.empty();
        for (const Variant& variant : variants)
            for (const phantom_float_ops* ops : sections()) {
                const bool fault = !hard.fault.empty();
                (fault ? faults : kinds[hard.kind])
                    .add(hard, variant, run_all_proxies(course, hard, *ops, variant), fault);
            }
    }
    fmt::print(
        "| | cases | \\|F\\| | step | else | `paper` | gaps | doubles | wrong side | no number | refused |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const auto step = [](double kr) { return kr > 0 ? fmt::format("{:.3f}", kr) : std::string("–"); };
    const auto print = [&step](const char* name, const Summary& s) {
        fmt::print("| {} | {} | {:.4f} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, s.cases, s.excess,
                   step(s.promised), step(s.elsewhere), step(s.paper), s.gaps, s.doubles, s.wrong,
                   s.not_numbers, s.refused);
    };
    for (const auto& [kind, summary] : kinds)
        print(title(kind), summary);
    if (faults.cases > 0)
        print("known faults", faults);
}

void print_head()
{
    fmt::print(
        "Forces in kR, steps in kR on 1 um (jump: what is left of one on 3 nm); the worst of all samples.\n\n"
        "  {:20} {:18} {:>9} {:>8} {:>8} {:>8} {:>8} {:>6} {:>7} {:>6} {:>4} {:>7}\n",
        "model", "arithmetic", "|F|", "step", "jump", "inside", "jump", "gaps", "doubles", "wrong", "NaN",
        "refused");
}

} // namespace

int main(int argc, char** argv)
{
    std::uint64_t seed = 0, count = 0;
    const char* word = "";
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--random") && i + 2 < argc) {
            seed = std::stoull(argv[++i]);
            count = std::stoull(argv[++i]);
        } else if (!std::strcmp(argv[i], "--markdown")) {
            print_markdown();
            return 0;
        } else if (!std::strcmp(argv[i], "--case") && i + 1 < argc) {
            word = argv[++i];
        } else {
            fmt::print(stderr, "{}", usage);
            return 2;
        }
    }
    print_head();
    unsigned faults = 0;
    if (count > 0) {
        for (std::uint64_t n = 0; n < count; ++n)
            faults += print_case(random_case(seed + n));
    } else {
        for (const Case& hard : corpus())
            if (hard.name.find(word) != std::string::npos)
                faults += print_case(hard);
    }
    fmt::print("\n{} promises broken\n", faults);
    return faults > 0;
}
