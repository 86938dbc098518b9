// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/blf.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

constexpr std::string_view kFileMark = "LOGG";
constexpr std::string_view kObjectMark = "LOBJ";
constexpr std::size_t kBaseHeader = 16;    // mark, header's size and version, object's size, type
constexpr std::size_t kObjectHeader = 32;  // and flags, client, version, stamp
constexpr std::size_t kMostBytesOfObject = std::size_t{16} << 20;
constexpr std::uint32_t kContainer = 10;

/// Numbers of a piece of bytes, lowest byte first; zeros behind its end.
class Bytes {
 public:
  explicit Bytes(std::string_view text) : text_(text) {}

  [[nodiscard]] std::uint64_t at(std::size_t from, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count && from + i < text_.size(); ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(text_[from + i])} << (8 * i);
    }
    return value;
  }
  [[nodiscard]] std::uint8_t u8(std::size_t from) const { return static_cast<std::uint8_t>(at(from, 1)); }
  [[nodiscard]] std::uint16_t u16(std::size_t from) const { return static_cast<std::uint16_t>(at(from, 2)); }
  [[nodiscard]] std::uint32_t u32(std::size_t from) const { return static_cast<std::uint32_t>(at(from, 4)); }

 private:
  std::string_view text_;
};

/// SYSTEMTIME: year, month, day of week, day, hour, minute, second, ms; 0 when it is no date.
double seconds_of_system_time(const Bytes& bytes, std::size_t from) {
  const std::chrono::year_month_day date{std::chrono::year(bytes.u16(from)), std::chrono::month(bytes.u16(from + 2)),
                                         std::chrono::day(bytes.u16(from + 6))};
  if (!date.ok()) return 0;
  const double days_s = 86400.0 * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  return days_s + 3600.0 * bytes.u16(from + 8) + 60.0 * bytes.u16(from + 10) + bytes.u16(from + 12) +
         1e-3 * bytes.u16(from + 14);
}

class Blf final : public CanFrames {
 public:
  explicit Blf(OpenedLog log) : log_(std::move(log)) {
    const std::string head = read_bytes(144);
    const Bytes bytes(head);
    const std::size_t size = bytes.u32(4);
    if (head.size() < 144 || size < 144 || size > kMostBytesOfObject) complain("the head of a BLF file");
    start_s_ = seconds_of_system_time(bytes, 40);
    (void)read_bytes(size - 144);
  }

  bool next(CanFrame& frame) override {
    std::string object;
    while (next_object(object)) {
      if (take(object, frame)) return true;
    }
    return false;
  }

 private:
  std::string read_bytes(std::size_t count) {
    std::string bytes(count, '\0');
    log_.in->read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(log_.in->gcount()));
    read_ += bytes.size();
    return bytes;
  }

  [[noreturn]] void complain(const std::string& expected) const {
    throw bad_input({.file = log_.name,
                     .expected = expected,
                     .found = fmt::format("something else before byte {}", read_),
                     .advice = "record or copy the file anew"});
  }

  /// The next object that is no container, out of the containers or loose.
  bool next_object(std::string& object) {
    while (!object_of_container(object)) {
      std::string header = read_bytes(kBaseHeader);
      if (header.size() < kBaseHeader) return false;
      if (!header.starts_with(kObjectMark)) complain("an object of a BLF file");
      const Bytes bytes(header);
      const std::size_t size = bytes.u32(8);
      if (size < kBaseHeader || size > kMostBytesOfObject) complain("an object of a BLF file of 16 MiB or less");
      const std::string body = read_bytes(size - kBaseHeader);
      if (body.size() < size - kBaseHeader) return false;  // the logger was stopped within it
      (void)read_bytes(size % 4);
      if (bytes.u32(12) == kContainer) {
        unpack(body);
      } else {
        object = header + body;
        return true;
      }
    }
    return true;
  }

  /// Compression's method, six bytes, size, four bytes, data.
  void unpack(const std::string& body) {
    constexpr std::size_t kHead = 16;
    if (body.size() < kHead) complain("a container of a BLF file");
    const Bytes bytes(body);
    const std::uint16_t method = bytes.u16(0);
    const std::size_t size = bytes.u32(8);
    held_.erase(0, used_);
    used_ = 0;
    if (method == 0) {
      held_.append(body, kHead);
    } else if (method == 2 && size <= kMostBytesOfObject) {
      std::vector<unsigned char> out(std::max<std::size_t>(size, 1));
      const std::vector<unsigned char> packed(body.begin() + kHead, body.end());
      auto length = static_cast<uLongf>(out.size());
      if (uncompress(out.data(), &length, packed.data(), static_cast<uLong>(packed.size())) != Z_OK) {
        complain("a container that unpacks");
      }
      held_.append(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(length));
    } else {
      complain("a container packed with zlib, of 16 MiB or less");
    }
    if (held_.size() > 2 * kMostBytesOfObject) complain("objects of 16 MiB or less");
  }

  /// The next whole object of what is unpacked; one that the container's end cuts goes on in the next.
  bool object_of_container(std::string& object) {
    const std::size_t at = held_.find(kObjectMark, used_);  // objects are padded, by rules that differ
    if (at == std::string::npos || held_.size() - at < kBaseHeader) return false;
    const std::size_t size = Bytes(std::string_view(held_).substr(at)).u32(8);
    if (size < kBaseHeader || size > kMostBytesOfObject) complain("an object of a BLF file of 16 MiB or less");
    if (held_.size() - at < size) return false;
    object = held_.substr(at, size);
    used_ = at + size;
    return true;
  }

  bool take(const std::string& object, CanFrame& frame) const {
    const Bytes bytes(object);
    const std::size_t at = bytes.u16(4);  // the header's size
    const std::uint32_t type = bytes.u32(12);
    if (at < kObjectHeader || object.size() < at + 16) return false;
    std::size_t data = 0;
    std::size_t count = 0;
    std::uint32_t id = 0;
    bool remote = false;
    constexpr std::uint32_t kRemoteOfFd64 = 0x10;
    switch (type) {
      case 1:
      case 86:
        remote = (bytes.u8(at + 2) & 0x80U) != 0;
        count = std::min<std::size_t>(bytes.u8(at + 3), 8);
        id = bytes.u32(at + 4);
        data = at + 8;
        break;
      case 100:
        id = bytes.u32(at + 4);
        count = bytes.u8(at + 14);
        data = at + 20;
        break;
      case 101:
        count = bytes.u8(at + 2);
        id = bytes.u32(at + 4);
        remote = (bytes.u32(at + 12) & kRemoteOfFd64) != 0;
        data = at + 40;
        break;
      default:
        return false;
    }
    if (remote || count > CanFrame::kMostBytes || object.size() < data + count) return false;
    frame = CanFrame{.id = id & 0x1fffffffU, .extended = (id & 0x80000000U) != 0, .bytes = count};
    for (std::size_t i = 0; i < count; ++i) frame.data.at(i) = bytes.u8(data + i);
    const double unit_s = bytes.u32(16) == 1 ? 1e-5 : 1e-9;
    frame.time_s = start_s_ + unit_s * static_cast<double>(bytes.at(24, 8));
    return true;
  }

  OpenedLog log_;
  std::string held_{};
  std::size_t used_ = 0;
  std::size_t read_ = 0;
  double start_s_ = 0;
};

}  // namespace

bool is_blf(std::string_view first_bytes) { return first_bytes.starts_with(kFileMark); }

std::unique_ptr<CanFrames> blf_frames(OpenedLog log) { return std::make_unique<Blf>(std::move(log)); }

}  // namespace steerid
