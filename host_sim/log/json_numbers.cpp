// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <nlohmann/json.hpp>

#include "log/message_numbers.hpp"

namespace steerid {
namespace {

constexpr int kDeepest = 32;

class JsonNumbers final : public MessageNumbers {
 public:
  bool read(std::string_view message, const TakeNumber& take) const override {
    const nlohmann::json json = nlohmann::json::parse(message, nullptr, false);
    if (!json.is_object()) return false;
    FieldPath path;
    visit(json, path, take, 0);
    return true;
  }

 private:
  static void visit(const nlohmann::json& json, FieldPath& path, const TakeNumber& take, int depth) {
    if (json.is_number()) {
      take(path.text(), json.get<double>());
    } else if (json.is_boolean()) {
      take(path.text(), json.get<bool>() ? 1 : 0);
    } else if (json.is_object() && depth < kDeepest) {
      for (const auto& [key, value] : json.items()) {
        const FieldPath::Step step(path, key);
        visit(value, path, take, depth + 1);
      }
    } else if (json.is_array() && json.size() <= kMostElements && depth < kDeepest) {
      for (std::size_t i = 0; i < json.size(); ++i) {
        const FieldPath::Step step(path, i);
        visit(json[i], path, take, depth + 1);
      }
    }
  }
};

}  // namespace

std::unique_ptr<MessageNumbers> json_numbers() { return std::make_unique<JsonNumbers>(); }

}  // namespace steerid
