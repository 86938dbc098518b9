// Independent jobs on every core, with one place that hears how far they are.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace steerid {

/// Calls work(0) .. work(count - 1), each once, on `threads` threads (0: one a core); rethrows the first exception. The
/// calling thread works as well, and is the one that calls report(done).
template <class Work>
void for_all(std::size_t count, unsigned threads, const std::function<void(std::size_t done)>& report, Work work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto labour = [&](bool reports) {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        work(i);
        const std::size_t finished = ++done;
        if (reports) report(finished);
      }
    } catch (...) {
      const std::lock_guard lock(failure_lock);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(labour, false);
    labour(true);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace steerid
