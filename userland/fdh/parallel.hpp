// SPDX-License-Identifier: GPL-2.0-or-later
// Fork and join over threads that live as long as the work. Results never depend on how many there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace phantom::fdh {

/// 0 asks for all cores.
inline unsigned thread_count(unsigned asked)
{
    return asked ? asked : std::max(1u, std::thread::hardware_concurrency());
}

/// Runs both; `first` on a thread of its own if one is to be had. Neither may throw.
template <class First, class Second>
void fork_join(First&& first, Second&& second)
{
    std::thread thread;
    try {
        thread = std::thread(first);
    } catch (const std::system_error&) {
        first();
    }
    second();
    if (thread.joinable())
        thread.join();
}

/// Runs `work` on that many threads at once, this one among them, or on as many as are to be had. It may not
/// throw.
template <class Work>
void on_threads(unsigned threads, const Work& work)
{
    if (threads <= 1)
        work();
    else
        fork_join([&] { on_threads(threads / 2, work); }, [&] { on_threads(threads - threads / 2, work); });
}

/// body(begin, end) over [begin, end) in one piece per thread. body may not throw.
template <class Body>
void parallel_for(std::size_t begin, std::size_t end, unsigned threads, const Body& body)
{
    constexpr std::size_t worth_a_thread = 4096;
    if (threads <= 1 || end - begin < worth_a_thread) {
        body(begin, end);
        return;
    }
    const std::size_t middle = begin + (end - begin) * (threads / 2) / threads;
    fork_join([&] { parallel_for(begin, middle, threads / 2, body); },
              [&] { parallel_for(middle, end, threads - threads / 2, body); });
}

} // namespace phantom::fdh
