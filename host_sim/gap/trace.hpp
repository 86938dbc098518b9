#pragma once
#include <atomic>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <map>
#include <mutex>
#include <string>
namespace steerid {
struct Tally {
  std::mutex guard;
  std::map<std::string, std::pair<double, int>> wall;
  ~Tally() {
    for (const auto& [k, v] : wall) std::fprintf(stderr, "TALLY %-22s %7.3f s %d\n", k.c_str(), v.first, v.second);
  }
};
inline Tally tally;
struct Timed {
  std::string what;
  std::chrono::steady_clock::time_point t0 = std::chrono::steady_clock::now();
  explicit Timed(std::string w) : what(std::move(w)) {}
  ~Timed() {
    const double d = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
    const std::lock_guard lock(tally.guard);
    auto& one = tally.wall[what];
    one.first += d;
    one.second += 1;
  }
};
}  // namespace steerid
