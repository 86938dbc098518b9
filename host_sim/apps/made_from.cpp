// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/made_from.hpp"

#include "fleet/file_hash.hpp"

namespace steerid {

const std::string& this_program() {
  static const std::string kHash = sha256_of_file("/proc/self/exe").sha256;
  return kHash;
}

nlohmann::ordered_json program_json() { return {{"version", STEERID_VERSION}, {"sha256", this_program()}}; }

nlohmann::ordered_json input_json(const std::filesystem::path& file) {
  nlohmann::ordered_json json = {{"name", file.string()}};
  json.update(fingerprint(file));
  return json;
}

nlohmann::ordered_json fingerprint(const std::filesystem::path& file) {
  if (file == "-") return {{"bytes", nullptr}, {"sha256", nullptr}};
  const FileHash hash = sha256_of_file(file);
  return {{"bytes", hash.bytes}, {"sha256", hash.sha256}};
}

}  // namespace steerid
