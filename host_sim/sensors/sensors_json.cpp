// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/sensors_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

using nlohmann::json;

/// An object whose keys are taken one by one; what is left over in the end is a mistake of the writer.
class Object {
 public:
  Object(const json& object, std::string path, const std::string& file)
      : object_(object), path_(std::move(path)), file_(file) {
    if (!object.is_object()) complain("", "an object in braces", object.dump());
  }

  void number(const std::string& key, double& into, double low, double high) {
    const json* value = take(key);
    if (value == nullptr) return;
    const double number = value->is_number() ? value->get<double>() : std::nan("");
    if (!(number >= low && number <= high)) {
      complain(key, fmt::format("a number from {} to {}", low, high), value->dump());
    }
    into = number;
  }

  void microseconds(const std::string& key, std::int64_t& into, std::int64_t longest_us) {
    double seconds = static_cast<double>(into) * 1e-6;
    number(key, seconds, 0.0, static_cast<double>(longest_us) * 1e-6);
    into = std::llround(seconds * 1e6);
  }

  void flag(const std::string& key, bool& into) {
    const json* value = take(key);
    if (value == nullptr) return;
    if (!value->is_boolean()) complain(key, "true or false", value->dump());
    into = value->get<bool>();
  }

  void during(sensor::During& into) {
    number("onset_s", into.onset_s, 0.0, kEver);
    number("length_s", into.length_s, 0.0, kEver);
  }

  /// Hands the object under `key`, when there is one, to `read` and checks that it used every key.
  template <class Read>
  void object(const std::string& key, Read read) {
    const json* value = take(key);
    if (value == nullptr) return;
    Object inner(*value, path_ + "/" + key, file_);
    read(inner);
    inner.finish();
  }

  void finish() const {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        complain(key, fmt::format("one of {}", fmt::join(known_, ", ")), in_quotes(key));
      }
    }
  }

 private:
  static constexpr double kEver = 1e12;

  const json* take(const std::string& key) {
    known_.push_back(key);
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }

  [[noreturn]] void complain(const std::string& key, std::string expected, std::string found) const {
    throw bad_input({.file = file_ + ", at " + path_ + (key.empty() ? "" : "/" + key),
                     .expected = std::move(expected),
                     .found = found.size() > 40 ? found.substr(0, 40) + "..." : std::move(found)});
  }

  const json& object_;
  std::string path_;
  const std::string& file_;
  std::vector<std::string> known_;
};

void read_dropout(Object& from, sensor::Dropout& into, bool can_flag) {
  from.number("fraction", into.fraction, 0.0, 0.9);
  from.number("mean_run", into.mean_run, 1.0, 1e6);
  if (can_flag) from.flag("flagged", into.flagged);
  from.during(into.during);
}

void read_channel(Object& from, sensor::ChannelDefects& into, const std::string& unit) {
  constexpr double kAny = 1e6;
  constexpr double kSmall = 1e-9;
  from.object("lag", [&](Object& lag) {
    lag.number("time_constant_s", into.lag.time_constant_s, 0.0, sensor::Lag::kLongestS);
    lag.during(into.lag.during);
  });
  from.object("delay", [&](Object& delay) {
    delay.microseconds("delay_s", into.delay.delay_us, sensor::Delay::kLongestUs);
    delay.during(into.delay.during);
  });
  from.object("gain", [&](Object& gain) {
    gain.number("factor", into.gain.factor, -kAny, kAny);
    gain.during(into.gain.during);
  });
  from.object("bias", [&](Object& bias) {
    bias.number("offset_" + unit, into.bias.offset, -kAny, kAny);
    bias.number("drift_" + unit + "_per_s", into.bias.drift_per_s, -kAny, kAny);
    bias.during(into.bias.during);
  });
  from.object("noise", [&](Object& noise) {
    noise.number("sd_" + unit, into.noise.sd, 0.0, kAny);
    noise.during(into.noise.during);
  });
  from.object("saturation", [&](Object& saturation) {
    saturation.number("limit_" + unit, into.saturation.limit, kSmall, kAny);
    saturation.during(into.saturation.during);
  });
  from.object("resolution", [&](Object& resolution) {
    resolution.number("step_" + unit, into.resolution.step, 0.0, kAny);
    resolution.during(into.resolution.during);
  });
  from.object("dropout", [&](Object& dropout) { read_dropout(dropout, into.dropout, true); });
  from.object("stuck", [&](Object& stuck) { stuck.during(into.stuck.during); });
}

/// What every message has.
void read_message(Object& from, SensorDefects& into) {
  from.object("torque_motor", [&](Object& channel) { read_channel(channel, into.torque_motor, "nm"); });
  from.object("angle", [&](Object& channel) { read_channel(channel, into.angle, "rad"); });
  from.object("jitter", [&](Object& jitter) {
    jitter.microseconds("spread_s", into.jitter.spread_us, sensor::Jitter::kWidestUs);
    jitter.flag("stamped", into.jitter.stamped);
    jitter.during(into.jitter.during);
  });
  from.object("message_loss", [&](Object& loss) { read_dropout(loss, into.message_loss, false); });
}

/// Hands the sensors, under their key, to `read`.
template <class Read>
void read_sensors(const json& sensors, const std::string& file, Read read) {
  json whole = json::object();
  whole["sensors"] = sensors;
  Object root(whole, "", file);
  root.object("sensors", read);
}

}  // namespace

SensorDefects sensors_from_json(const json& sensors, const std::string& file) {
  SensorDefects defects;
  read_sensors(sensors, file, [&](Object& from) {
    from.object("torque_driver", [&](Object& channel) { read_channel(channel, defects.torque_driver, "nm"); });
    read_message(from, defects);
  });
  return defects;
}

ColumnSensorDefects column_sensors_from_json(const json& sensors, const std::string& file) {
  ColumnSensorDefects defects;
  read_sensors(sensors, file, [&](Object& from) {
    from.object("torque_bar", [&](Object& channel) { read_channel(channel, defects.torque_bar, "nm"); });
    from.object("torque_rim", [&](Object& channel) { read_channel(channel, defects.torque_rim, "nm"); });
    from.object("probe", [&](Object& channel) { read_channel(channel, defects.probe, "nm"); });
    read_message(from, defects.wheel);
  });
  return defects;
}

}  // namespace steerid
