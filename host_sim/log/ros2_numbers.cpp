// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// CDR as ROS 2's middlewares write it (OMG DDS-RTPS 10, "plain CDR"): four bytes say the order of the bytes, then each
// number stands at a multiple of its own length (in version 2, of four at most); lists and texts follow their count.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

#include "log/message_numbers.hpp"
#include "log/ros2_definition.hpp"

namespace steerid {
namespace {

class Cdr {
 public:
  /// Empty where the head is none of plain CDR's.
  static std::optional<Cdr> of(std::string_view message) {
    if (message.size() < kHead || message[0] != 0) return std::nullopt;
    const char form = message[1];
    const bool second = form == 6 || form == 7;
    if (form != 0 && form != 1 && !second) return std::nullopt;
    return Cdr(message.substr(kHead), form % 2 == 1, second ? 4 : 8);
  }

  std::optional<std::uint64_t> whole(std::size_t bytes) {
    align(bytes);
    if (at_ > data_.size() || data_.size() - at_ < bytes) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::size_t place = lowest_first_ ? i : bytes - 1 - i;
      value |= std::uint64_t{static_cast<unsigned char>(data_[at_ + i])} << (8 * place);
    }
    at_ += bytes;
    return value;
  }

  bool pass_over(std::size_t bytes_of_one, std::uint64_t count) {
    if (count == 0) return true;
    align(bytes_of_one);
    if (at_ > data_.size() || count > (data_.size() - at_) / bytes_of_one) return false;
    at_ += static_cast<std::size_t>(count) * bytes_of_one;
    return true;
  }

 private:
  static constexpr std::size_t kHead = 4;

  Cdr(std::string_view data, bool lowest_first, std::size_t most)
      : data_(data), lowest_first_(lowest_first), most_(most) {}

  void align(std::size_t bytes) {
    const std::size_t step = std::min(bytes, most_);
    at_ = (at_ + step - 1) / step * step;
  }

  std::string_view data_;
  bool lowest_first_;
  std::size_t most_;
  std::size_t at_ = 0;
};

double value_of(const Ros2Field& field, std::uint64_t bits) {
  switch (field.kind) {
    case Ros2Kind::kFloat:
      if (field.bytes == 8) return std::bit_cast<double>(bits);
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case Ros2Kind::kWholeSigned: {
      const std::size_t shift = 64 - 8 * field.bytes;
      return static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift);
    }
    default:
      return static_cast<double>(bits);
  }
}

class Ros2Numbers final : public MessageNumbers {
 public:
  explicit Ros2Numbers(Ros2Types types) : types_(std::move(types)) {}

  bool read(std::string_view message, const TakeNumber& take) const override {
    auto cdr = Cdr::of(message);
    FieldPath path;
    return cdr && read_type(0, *cdr, path, &take);
  }

 private:
  /// Without `take` it is passed over.
  bool read_type(std::size_t type, Cdr& cdr, FieldPath& path, const TakeNumber* take) const {
    if (types_[type].empty()) return cdr.pass_over(1, 1);  // a message without fields has one byte
    return std::ranges::all_of(types_[type], [&](const Ros2Field& field) {
      const FieldPath::Step step(path, field.name);
      return read_field(field, cdr, path, take);
    });
  }

  bool read_field(const Ros2Field& field, Cdr& cdr, FieldPath& path, const TakeNumber* take) const {
    if (field.count == Ros2Count::kOne) return read_one(field, cdr, path, take);
    const auto count = field.count == Ros2Count::kFixed ? std::optional<std::uint64_t>(field.fixed) : cdr.whole(4);
    if (!count) return false;
    const bool short_list = *count <= kMostElements;
    if (!short_list && field.bytes > 0) return cdr.pass_over(field.bytes, *count);
    for (std::uint64_t i = 0; i < *count; ++i) {
      const FieldPath::Step step(path, static_cast<std::size_t>(i));
      if (!read_one(field, cdr, path, short_list ? take : nullptr)) return false;
    }
    return true;
  }

  bool read_one(const Ros2Field& field, Cdr& cdr, FieldPath& path, const TakeNumber* take) const {
    if (field.kind == Ros2Kind::kMessage) return read_type(field.message, cdr, path, take);
    const auto bits = cdr.whole(field.kind == Ros2Kind::kText ? 4 : field.bytes);
    if (!bits) return false;
    if (field.kind == Ros2Kind::kText) return cdr.pass_over(1, *bits);
    if (take != nullptr) (*take)(path.text(), value_of(field, *bits));
    return true;
  }

  Ros2Types types_;
};

}  // namespace

std::unique_ptr<MessageNumbers> ros2_numbers(std::string_view type, std::string_view definition) {
  auto types = parse_ros2_definition(type, definition);
  return types ? std::make_unique<Ros2Numbers>(std::move(*types)) : nullptr;
}

}  // namespace steerid
