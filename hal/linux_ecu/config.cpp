#include "linux_ecu/config.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "linux_gpiod/failure.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::Bias;
using linux_gpiod::BoardLines;
using linux_gpiod::Failure;
using linux_gpiod::LineConfig;
using nlohmann::json;

/// A value with the way to it, so that every complaint can say where it is in the file.
class Entry {
 public:
  Entry(const json& value, const std::string& text, std::string path)
      : value_(&value), text_(&text), file_(std::move(path)) {}

  [[nodiscard]] const json& value() const { return *value_; }

  /// Line in the file of the last key on the way here: keys are looked for one after the other.
  [[noreturn]] void complain(const std::string& what) const {
    std::size_t at = 0;
    std::string name;
    for (const std::string& key : keys_) {
      const std::size_t found = text_->find('"' + key + '"', at);
      if (found != std::string::npos) at = found;
      name += (name.empty() ? "" : ".") + key;
    }
    const auto lines = std::count(text_->begin(), text_->begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    throw Failure(file_ + ":" + std::to_string(lines) + ": " + (name.empty() ? "" : name + " ") + what);
  }

  [[nodiscard]] Entry at(const std::string& key) const {
    Entry entry(value_->at(key), *text_, file_);
    entry.keys_ = keys_;
    entry.keys_.push_back(key);
    return entry;
  }
  [[nodiscard]] bool has(const std::string& key) const { return value_->contains(key); }

  /// An object with no other keys than `known`.
  void must_be_object(const std::vector<std::string>& known) const {
    if (!value_->is_object()) complain("must be an object {...}");
    for (const auto& [key, unused] : value_->items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      std::string all;
      for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
      at(key).complain("is not known here; known are " + all);
    }
  }

  [[nodiscard]] std::string text() const {
    if (!value_->is_string() || value_->get<std::string>().empty()) complain("must be a text in quotes");
    return value_->get<std::string>();
  }
  [[nodiscard]] std::int64_t integer(std::int64_t lowest, std::int64_t highest) const {
    const bool whole = value_->is_number_integer();
    const bool small = whole && (!value_->is_number_unsigned() || value_->get<std::uint64_t>() <= INT64_MAX);
    if (!small || value_->get<std::int64_t>() < lowest || value_->get<std::int64_t>() > highest) {
      complain("must be a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
    }
    return value_->get<std::int64_t>();
  }
  [[nodiscard]] bool truth() const {
    if (!value_->is_boolean()) complain("must be true or false");
    return value_->get<bool>();
  }

 private:
  const json* value_;
  const std::string* text_;
  std::string file_;
  std::vector<std::string> keys_;
};

Bias bias(const Entry& entry) {
  const std::string text = entry.text();
  if (text == "as-is") return Bias::kAsIs;
  if (text == "disabled") return Bias::kDisabled;
  if (text == "pull-up") return Bias::kPullUp;
  if (text == "pull-down") return Bias::kPullDown;
  entry.complain("must be \"as-is\", \"disabled\", \"pull-up\" or \"pull-down\"");
}

LineConfig line(const Entry& entry) {
  entry.must_be_object({"chip", "line", "active_low", "bias"});
  LineConfig config;
  if (entry.has("chip")) config.chip = entry.at("chip").text();
  if (!entry.has("line")) entry.complain("needs \"line\": the line's name or its offset");
  const Entry which = entry.at("line");
  if (which.value().is_string()) {
    config.name = which.text();
  } else {
    config.offset = static_cast<unsigned>(which.integer(0, 4095));
    if (config.chip.empty()) entry.complain("needs \"chip\" beside the offset of a line, \"gpiochip0\" for example");
  }
  if (entry.has("active_low")) config.active_low = entry.at("active_low").truth();
  if (entry.has("bias")) config.bias = bias(entry.at("bias"));
  return config;
}

BoardLines board_lines(const Entry& entry) {
  BoardLines lines;
  const std::array<std::pair<const char*, std::optional<LineConfig> BoardLines::*>, 5> all{
      {{"sample_ready", &BoardLines::sample_ready},
       {"probe_enable", &BoardLines::probe_enable},
       {"valid", &BoardLines::valid},
       {"fault", &BoardLines::fault},
       {"heartbeat", &BoardLines::heartbeat}}};
  entry.must_be_object({"sample_ready", "probe_enable", "valid", "fault", "heartbeat"});
  for (const auto& [name, member] : all) {
    if (entry.has(name)) lines.*member = line(entry.at(name));
  }
  return lines;
}

}  // namespace

Config parse_config(const std::string& text, const std::string& path) {
  json root;
  try {
    root = json::parse(text, nullptr, true, true);
  } catch (const json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw Failure(path + ":" + std::to_string(std::count(text.begin(), end, '\n') + 1) +
                  ": is not JSON here; look for a missing comma, quote or bracket just before");
  }
  const Entry all(root, text, path);
  all.must_be_object({"can", "lines", "state_file", "wheel", "priority"});
  if (!all.has("can")) all.complain("needs \"can\": the CAN interface, \"can0\" for example");
  Config config;
  config.can = all.at("can").text();
  if (config.can.size() > 15) all.at("can").complain("must be an interface name of at most 15 characters");
  if (all.has("lines")) config.lines = board_lines(all.at("lines"));
  if (all.has("state_file")) config.state_file = all.at("state_file").text();
  if (all.has("wheel")) config.wheel = static_cast<std::uint32_t>(all.at("wheel").integer(0, UINT32_MAX));
  if (all.has("priority")) config.priority = static_cast<int>(all.at("priority").integer(0, 99));
  return config;
}

Config read_config(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) {
    throw Failure("cannot read the config file " + path + ": " +
                  linux_gpiod::reason(errno, "the daemon's user must be able to read it") +
                  "; give another with --config");
  }
  return parse_config(text.str(), path);
}

}  // namespace steerid::linux_ecu
