// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_ecu/config.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "linux_gpiod/descriptor.hpp"
#include "linux_gpiod/failure.hpp"
#include "port/equation.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::Bias;
using linux_gpiod::BoardLines;
using linux_gpiod::Descriptor;
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
  [[nodiscard]] double number(int lowest, int highest) const {
    const double number = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(number >= lowest && number <= highest)) {
      complain("must be a number from " + std::to_string(lowest) + " to " + std::to_string(highest));
    }
    return number;
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

std::uint8_t channels(const Entry& entry) {
  constexpr const char* kNeeds =
      "must be a list such as [\"torque_bar\", \"probe\"]: torque_bar, torque_rim, or torque_driver with torque_motor, "
      "and what else there is";
  if (!entry.value().is_array()) entry.complain(kNeeds);
  unsigned bits = kAngleValid;
  for (const json& one : entry.value()) {
    unsigned bit = 0;
    for (const std::uint8_t known :
         {kTorqueBarValid, kTorqueRimValid, kTorqueDriverValid, kTorqueMotorValid, kProbeValid}) {
      if (one == channel_name(known)) bit = known;
    }
    if (bit == 0) entry.complain(kNeeds);
    bits |= bit;
  }
  const auto chosen = static_cast<std::uint8_t>(bits);
  if (equation_of(chosen) == Equation::kNone) {
    entry.complain("identifies nothing; name torque_bar, torque_rim, or torque_driver with torque_motor");
  }
  return chosen;
}

/// "FILE:LINE: " of byte `at`.
std::string place(const std::string& text, const std::string& path, std::size_t at) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return path + ":" + std::to_string(std::count(text.begin(), end, '\n') + 1) + ": ";
}

/// Looks for keys that stand twice in one object, of which the parser would keep the last.
class Keys {
 public:
  Keys(const std::string& text, const std::string& path) : text_(&text), path_(&path) {}

  bool operator()(int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event != json::parse_event_t::key) return true;
    const auto key = parsed.get<std::string>();
    if (open_.back().insert(key).second) return true;
    const std::string quoted = '"' + key + '"';
    throw Failure(place(*text_, *path_, text_->rfind(quoted)) + quoted + " stands twice in one object; leave one");
  }

 private:
  const std::string* text_;
  const std::string* path_;
  std::vector<std::set<std::string>> open_;
};

json parse_json(const std::string& text, const std::string& path) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw Failure(path + ": is empty; it needs at least {\"can\": \"can0\"}");
  }
  try {
    return json::parse(text, Keys(text, path), true, true);
  } catch (const json::parse_error& error) {
    throw Failure(place(text, path, error.byte) +
                  "is not JSON here; look for a missing comma, quote or bracket just before");
  } catch (const json::out_of_range&) {
    throw Failure(path + ": holds a number that is too large for any key");
  }
}

/// All of a file that is small, as a config is. What is no file may never end, or never begin.
std::string text_of(const std::string& path) {
  constexpr std::size_t kLargest = 65'536;
  const std::string cannot = "cannot read the config file " + path + ": ";
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat what {};
  if (!file.open() || ::fstat(file.number(), &what) != 0) {
    throw Failure(cannot + linux_gpiod::reason(errno, "the daemon's user must be able to read it") +
                  "; give another with --config");
  }
  if (!S_ISREG(what.st_mode)) throw Failure(cannot + "it is no regular file; give another with --config");
  std::string text(kLargest + 1, '\0');
  std::size_t bytes = 0;
  for (ssize_t more = 1; more > 0 && bytes < text.size();
       bytes += static_cast<std::size_t>(std::max<ssize_t>(more, 0))) {
    more = ::read(file.number(), text.data() + bytes, text.size() - bytes);
    if (more < 0) throw Failure(cannot + linux_gpiod::reason(errno, ""));
  }
  if (bytes > kLargest) {
    throw Failure(cannot + "it is larger than 64 KiB, which no config is; give another with --config");
  }
  text.resize(bytes);
  return text;
}

}  // namespace

Config parse_config(const std::string& text, const std::string& path) {
  const json root = parse_json(text, path);
  const Entry all(root, text, path);
  all.must_be_object({"can", "lines", "channels", "state_file", "wheel", "wheel_friction_nm", "priority"});
  if (!all.has("can")) all.complain("needs \"can\": the CAN interface, \"can0\" for example");
  Config config;
  config.can = all.at("can").text();
  if (config.can.size() > 15) all.at("can").complain("must be an interface name of at most 15 characters");
  if (all.has("lines")) config.lines = board_lines(all.at("lines"));
  if (all.has("channels")) config.channels = channels(all.at("channels"));
  if (all.has("state_file")) config.state_file = all.at("state_file").text();
  if (all.has("wheel")) config.wheel = static_cast<std::uint32_t>(all.at("wheel").integer(0, UINT32_MAX));
  if (all.has("wheel_friction_nm")) config.wheel_friction_nm = all.at("wheel_friction_nm").number(0, 20);
  if (all.has("priority")) config.priority = static_cast<int>(all.at("priority").integer(0, 99));
  return config;
}

Config read_config(const std::string& path) { return parse_config(text_of(path), path); }

}  // namespace steerid::linux_ecu
