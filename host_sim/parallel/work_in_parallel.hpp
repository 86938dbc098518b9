// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A list of independent tasks on several threads. Results go to places of their own, so that the answer does not depend
// on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace steerid {

/// Calls task(i) once for every i below `count`, on `threads` threads (0: one a core). The first exception is rethrown.
/// `at_done` is told on the calling thread, which works as well, how many are done.
void work_in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t done)>& at_done,
                      const std::function<void(std::size_t)>& task);

/// The same with nobody to tell.
inline void work_in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& task) {
  work_in_parallel(
      count, threads, [](std::size_t) {}, task);
}

/// The number of threads that is asked for; 0: one a core.
[[nodiscard]] unsigned threads_of(unsigned asked);

/// Calls task(worker, i) once for every i below `count`, each worker on a thread of its own and always with the same i,
/// so that every worker may have a state that no other one touches meanwhile.
void share_among(std::size_t workers, std::size_t count,
                 const std::function<void(std::size_t worker, std::size_t i)>& task);

}  // namespace steerid
