// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/ros2_definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <utility>

#include "log/text.hpp"

namespace steerid {
namespace {

constexpr int kDeepest = 16;
constexpr std::size_t kMostOfFixed = std::size_t{1} << 24;

struct Number {
  std::string_view name;
  Ros2Kind kind;
  std::size_t bytes;
};

constexpr std::array kNumbers = {
    Number{"float64", Ros2Kind::kFloat, 8},     Number{"float32", Ros2Kind::kFloat, 4},
    Number{"bool", Ros2Kind::kWhole, 1},        Number{"byte", Ros2Kind::kWhole, 1},
    Number{"char", Ros2Kind::kWhole, 1},        Number{"uint8", Ros2Kind::kWhole, 1},
    Number{"int8", Ros2Kind::kWholeSigned, 1},  Number{"uint16", Ros2Kind::kWhole, 2},
    Number{"int16", Ros2Kind::kWholeSigned, 2}, Number{"uint32", Ros2Kind::kWhole, 4},
    Number{"int32", Ros2Kind::kWholeSigned, 4}, Number{"uint64", Ros2Kind::kWhole, 8},
    Number{"int64", Ros2Kind::kWholeSigned, 8},
};

/// The first word of a line, taken off it.
std::string_view take_word(std::string_view& line) {
  line = trimmed(line);
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  line = trimmed(line.substr(word.size()));
  return word;
}

/// "package/Type", of "package/msg/Type" too.
std::string short_name(std::string_view name) {
  std::string text(name);
  if (const std::size_t middle = text.find("/msg/"); middle != std::string::npos) text.erase(middle, 4);
  return text;
}

class Definitions {
 public:
  explicit Definitions(std::string_view type, std::string_view text) {
    std::string name = short_name(type);
    lines_.try_emplace(name);
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      while (line.ends_with('\r')) line.remove_suffix(1);
      if (line.starts_with("====")) {
        name.clear();
      } else if (line.starts_with("MSG:")) {
        name = short_name(trimmed(line.substr(4)));
        lines_.try_emplace(name);  // it may have no fields
      } else if (const auto words = trimmed(line.substr(0, line.find('#'))); !words.empty()) {
        lines_[name].push_back(words);
      }
    }
  }

  std::optional<Ros2Types> types_of(std::string_view type) {
    if (!take(short_name(type), 0)) return std::nullopt;
    return std::move(types_);
  }

 private:
  /// The index of a type among types_; nothing when it is not understood.
  std::optional<std::size_t> take(const std::string& name, int depth) {
    if (const auto known = indices_.find(name); known != indices_.end()) {
      return known->second;  // nothing while it is being made: then it holds itself
    }
    const auto lines = lines_.find(name);
    if (lines == lines_.end() || depth > kDeepest) return std::nullopt;
    indices_[name] = std::nullopt;
    const std::size_t index = types_.size();
    types_.emplace_back();
    const std::string package = name.substr(0, name.find('/'));
    for (const std::string_view line : lines->second) {
      std::string_view rest = line;
      Ros2Field field;
      std::string_view type = take_word(rest);
      const std::string_view word = take_word(rest);
      const std::size_t equals = word.find('=');
      if (equals != std::string_view::npos || rest.starts_with('=')) continue;  // a constant
      field.name = std::string(word);
      if (word.empty() || !take_count(type, field) || !take_kind(type, package, field, depth)) return std::nullopt;
      types_[index].push_back(std::move(field));
    }
    indices_[name] = index;
    return index;
  }

  /// "[3]", "[]" or "[<=3]" off the type's end.
  static bool take_count(std::string_view& type, Ros2Field& field) {
    if (!type.ends_with(']')) return true;
    const std::size_t open = type.find('[');
    if (open == std::string_view::npos) return false;
    const std::string_view inside = type.substr(open + 1, type.size() - open - 2);
    type = type.substr(0, open);
    field.count = Ros2Count::kAny;
    if (inside.empty() || inside.starts_with("<=")) return true;
    field.count = Ros2Count::kFixed;
    const auto [stop, error] = std::from_chars(inside.data(), inside.data() + inside.size(), field.fixed);
    return error == std::errc() && stop == inside.data() + inside.size() && field.fixed > 0 &&
           field.fixed <= kMostOfFixed;
  }

  bool take_kind(std::string_view type, const std::string& package, Ros2Field& field, int depth) {
    if (const auto* number = std::ranges::find(kNumbers, type, &Number::name); number != kNumbers.end()) {
      field.kind = number->kind;
      field.bytes = number->bytes;
      return true;
    }
    if (type == "string" || type.starts_with("string<=")) {
      field.kind = Ros2Kind::kText;
      return true;
    }
    field.kind = Ros2Kind::kMessage;
    const std::string name =
        type.find('/') == std::string_view::npos ? package + "/" + std::string(type) : short_name(type);
    const auto index = take(name, depth + 1);
    field.message = index.value_or(0);
    return index.has_value();
  }

  std::map<std::string, std::vector<std::string_view>> lines_{};
  std::map<std::string, std::optional<std::size_t>> indices_{};
  Ros2Types types_{};
};

}  // namespace

std::optional<Ros2Types> parse_ros2_definition(std::string_view type, std::string_view definition) {
  return Definitions(type, definition).types_of(type);
}

}  // namespace steerid
