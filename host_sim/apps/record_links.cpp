// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/record_links.hpp"

#include <fmt/format.h>

#include <system_error>

namespace steerid {
namespace {

/// RFC 3986: what is not unreserved is escaped, but for the slashes of the path.
std::string escaped(std::string_view path) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string out;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return out;
}

}  // namespace

std::string RecordLinks::to(std::string_view record) const {
  for (const char* file : {"report.html", "diagnosis.json", "identification.json"}) {
    std::error_code none;
    if (std::filesystem::exists(answers_ / record / file, none)) return "../" + escaped(record) + "/" + file;
  }
  return "./records.jsonl";  // the answer is in its line only
}

}  // namespace steerid
