#include "log/bad_input.hpp"

#include <fmt/format.h>

namespace steerid {

BadInput bad_input(const Complaint& complaint) {
  std::string sentence = complaint.file;
  if (complaint.line != 0) sentence += fmt::format(", line {}", complaint.line);
  if (!complaint.column.empty()) sentence += fmt::format(", column '{}'", complaint.column);
  if (!sentence.empty()) sentence += ": ";
  sentence += fmt::format("expected {}", complaint.expected);
  if (!complaint.found.empty()) sentence += fmt::format(", found {}", complaint.found);
  if (!complaint.advice.empty()) sentence += fmt::format("; {}", complaint.advice);
  return BadInput(sentence);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMostBytes = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, kMostBytes)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte > 0x7e) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  out += text.size() > kMostBytes ? "...\"" : "\"";
  return out;
}

}  // namespace steerid
