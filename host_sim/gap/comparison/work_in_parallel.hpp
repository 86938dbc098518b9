// A list of independent tasks on several threads. Results go to places of their own, so that the answer does not depend
// on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace steerid {

/// Calls task(i) for every i below `count`, on `threads` threads (0: one a core). The first exception is rethrown.
/// `at_done` is told on the calling thread how many are done.
void work_in_parallel(
    std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task,
    const std::function<void(std::size_t)>& at_done = [](std::size_t) {});

}  // namespace steerid
