#include "apps/seed_option.hpp"

#include <charconv>
#include <system_error>

namespace steerid {

void add_seed(CLI::App& command, std::uint64_t& seed, const std::string& of_what) {
  const auto whole_number = [](const std::string& text) {
    std::uint64_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc() && stop == text.data() + text.size()) return std::string();
    return "expected a whole number from 0 to 2^64 - 1, found " + text;
  };
  command.add_option("--seed", seed, of_what)->check(CLI::Validator(whole_number, ""))->capture_default_str();
}

}  // namespace steerid
