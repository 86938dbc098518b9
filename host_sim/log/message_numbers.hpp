// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The numbers in a message of a middleware, whatever its encoding: each with its path among the fields, as
// "header/stamp/sec" or "position[2]". Truth values count as 0 and 1; texts are passed over, and lists of more than
// kMostElements, which are pictures and clouds and no channels.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace steerid {

inline constexpr std::size_t kMostElements = 32;

using TakeNumber = std::function<void(std::string_view path, double value)>;

class MessageNumbers {
 public:
  MessageNumbers() = default;
  MessageNumbers(const MessageNumbers&) = delete;
  MessageNumbers& operator=(const MessageNumbers&) = delete;
  virtual ~MessageNumbers() = default;

  /// Gives each number of the message. False where the bytes are none; some numbers may have been given then.
  virtual bool read(std::string_view message, const TakeNumber& take) const = 0;
};

/// A path that grows and shrinks with the way through the fields.
class FieldPath {
 public:
  class Step {
   public:
    Step(FieldPath& path, std::string_view field) : path_(path.text_), before_(path_.size()) {
      if (before_ > 0) path_ += '/';
      path_ += field;
    }
    Step(FieldPath& path, std::size_t element) : path_(path.text_), before_(path_.size()) {
      path_ += '[' + std::to_string(element) + ']';
    }
    ~Step() { path_.resize(before_); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    std::string& path_;
    std::size_t before_;
  };

  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  std::string text_{};
};

/// Of JSON, with a schema or without.
[[nodiscard]] std::unique_ptr<MessageNumbers> json_numbers();

/// Of ROS 2's CDR. `type` is the message's, as "sensor_msgs/msg/JointState", `definition` its text with those that it
/// needs behind lines of "=", as rosbag2 writes it. Nothing where that is not understood.
[[nodiscard]] std::unique_ptr<MessageNumbers> ros2_numbers(std::string_view type, std::string_view definition);

}  // namespace steerid
