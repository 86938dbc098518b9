#include "apps/sealed_key.hpp"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw bad_input({.file = file.string(),
                     .expected = "a file of a blind study",
                     .found = "none",
                     .advice = "give the --out of `steerid study blind`"});
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::string sha256(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  std::string out;
  for (unsigned i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    out += kDigits[digest[i] >> 4U];
    out += kDigits[digest[i] & 15U];
  }
  return out;
}

std::string seal(const std::filesystem::path& folder, std::string_view key) {
  const std::filesystem::path sealed = folder / "sealed";
  make_output_folder(sealed);
  write_whole_file(sealed / "key.json", key);
  std::filesystem::permissions(sealed, std::filesystem::perms::owner_all);
  const std::string hash = sha256(key);
  write_whole_file(folder / "KEY_SHA256", hash + "  sealed/key.json\n");
  return hash;
}

std::string open_seal(const std::filesystem::path& folder) {
  const std::string key = read(folder / "sealed" / "key.json");
  const std::string published = read(folder / "KEY_SHA256").substr(0, 64);
  if (sha256(key) != published) {
    throw bad_input({.file = (folder / "sealed" / "key.json").string(),
                     .expected = "the key with the SHA-256 in KEY_SHA256",
                     .found = "another one",
                     .advice = "the answers have changed since they were sealed: draw anew"});
  }
  return key;
}

}  // namespace steerid
