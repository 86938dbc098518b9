// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Linked into the guest's daemon with --wrap: counts every call of the allocator and says the count on SIGUSR1, so that
// a test can see that the running loop makes none.
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>

namespace {

std::atomic<unsigned long> calls{0};

void say(int) {
  char text[32] = "allocations ";
  std::size_t at = 12;
  char digits[20];
  int count = 0;
  unsigned long value = calls.load();
  do {
    digits[count++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0);
  while (count > 0) text[at++] = digits[--count];
  text[at++] = '\n';
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, at);
}

[[maybe_unused]] const bool kListening = [] {
  struct sigaction action {};
  action.sa_handler = say;
  action.sa_flags = SA_RESTART;
  return ::sigaction(SIGUSR1, &action, nullptr) == 0;
}();

}  // namespace

extern "C" {
void* __real_malloc(std::size_t bytes);
void* __real_calloc(std::size_t count, std::size_t bytes);
void* __real_realloc(void* old, std::size_t bytes);

void* __wrap_malloc(std::size_t bytes) {
  ++calls;
  return __real_malloc(bytes);
}
void* __wrap_calloc(std::size_t count, std::size_t bytes) {
  ++calls;
  return __real_calloc(count, bytes);
}
void* __wrap_realloc(void* old, std::size_t bytes) {
  ++calls;
  return __real_realloc(old, bytes);
}
}
