// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "parallel/work_in_parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace steerid {

unsigned threads_of(unsigned asked) { return asked > 0 ? asked : std::max(1U, std::thread::hardware_concurrency()); }

void share_among(std::size_t workers, std::size_t count,
                 const std::function<void(std::size_t worker, std::size_t i)>& task) {
  work_in_parallel(workers, static_cast<unsigned>(workers), [&](std::size_t worker) {
    for (std::size_t i = worker; i < count; i += workers) task(worker, i);
  });
}

void work_in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t done)>& at_done,
                      const std::function<void(std::size_t)>& task) {
  threads = threads_of(threads);
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  std::exception_ptr failure;
  std::mutex guard;
  const auto work = [&](bool tells) {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard lock(guard);
        if (!failure) failure = std::current_exception();
        next = count;
      }
      const std::size_t finished = ++done;
      if (tells) at_done(finished);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < std::min<std::size_t>(threads, count); ++i) others.emplace_back(work, false);
  work(true);
  others.clear();
  if (failure) std::rethrow_exception(failure);
  at_done(count);
}

}  // namespace steerid
