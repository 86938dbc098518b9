// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/can_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "log/bad_input.hpp"
#include "log/blf.hpp"
#include "log/can_frame.hpp"
#include "log/can_text.hpp"
#include "log/dbc.hpp"
#include "log/stamp_limits.hpp"

namespace steerid {
namespace {

class CanSource final : public LogSource {
 public:
  explicit CanSource(OpenedLog log, std::unique_ptr<CanFrames> (*open)(OpenedLog)) : name_(log.name) {
    if (log.dbc.empty()) {
      throw bad_input({.file = log.name,
                       .expected = "what its CAN frames mean",
                       .found = "none",
                       .advice = "name the bus's DBC file with --dbc FILE"});
    }
    for (const std::filesystem::path& file : log.dbc) {
      const std::vector<DbcMessage> more = load_dbc(file);
      messages_.insert(messages_.end(), more.begin(), more.end());
    }
    std::map<std::string, int> count;
    for (const DbcMessage& message : messages_) {
      for (const DbcSignal& signal : message.signals) ++count[signal.name];
    }
    for (std::size_t message = 0; message < messages_.size(); ++message) {
      const auto& signals = messages_[message].signals;
      for (std::size_t signal = 0; signal < signals.size(); ++signal) {
        const std::string& name = signals[signal].name;
        columns_.push_back(
            {.name = count[name] > 1 ? messages_[message].name + "." + name : name, .unit = signals[signal].unit});
        places_.push_back({message, signal});
      }
    }
    frames_ = open(std::move(log));
  }

  [[nodiscard]] const std::vector<LogColumn>& columns() const override { return columns_; }
  [[nodiscard]] bool time_is_a_column() const override { return false; }

  [[nodiscard]] std::vector<StampedColumns> read(const Wanted& wanted) override {
    std::map<std::pair<std::uint32_t, bool>, Group> groups = groups_of(wanted);
    CanFrame frame;
    while (frames_->next(frame)) {
      const auto found = groups.find({frame.id, frame.extended});
      if (found != groups.end()) take(found->second, frame, wanted);
    }
    std::vector<StampedColumns> all;
    all.reserve(groups.size());
    for (auto& [key, group] : groups) all.push_back(std::move(group.columns));
    return all;
  }

 private:
  struct Place {
    std::size_t message;
    std::size_t signal;
  };

  /// The wanted signals of one message.
  struct Group {
    const DbcSignal* selector = nullptr;
    std::vector<const DbcSignal*> signals{};
    StampedColumns columns{};
  };

  [[nodiscard]] std::map<std::pair<std::uint32_t, bool>, Group> groups_of(const Wanted& wanted) const {
    std::map<std::pair<std::uint32_t, bool>, Group> groups;
    for (std::size_t i = 0; i < wanted.columns.size(); ++i) {
      const Place& place = places_.at(wanted.columns[i].column);
      const DbcMessage& message = messages_[place.message];
      Group& group = groups[{message.id, message.extended}];
      for (const DbcSignal& signal : message.signals) {
        if (signal.selects) group.selector = &signal;
      }
      group.signals.push_back(&message.signals[place.signal]);
      group.columns.wanted.push_back(i);
      group.columns.values.emplace_back();
    }
    return groups;
  }

  void take(Group& group, const CanFrame& frame, const Wanted& wanted) const {
    StampedColumns& columns = group.columns;
    if (std::abs(frame.time_s) > kLatestTimeS || (!columns.time_s.empty() && frame.time_s < columns.time_s.back())) {
      const double before_s = columns.time_s.empty() ? -kLatestTimeS : columns.time_s.back();
      throw bad_input(
          {.file = name_,
           .expected = fmt::format("a time of {} to {:g} s in frame {:X}", before_s, kLatestTimeS, frame.id),
           .found = fmt::format("{} s", frame.time_s),
           .advice = "split the file where its clock goes back"});
    }
    columns.time_s.push_back(frame.time_s);
    const auto selected = group.selector == nullptr ? std::nullopt : group.selector->raw(frame);
    for (std::size_t i = 0; i < group.signals.size(); ++i) {
      const DbcSignal& signal = *group.signals[i];
      const bool there = !signal.selected_by || signal.selected_by == selected;
      const auto value = there ? signal.value(frame) : std::nullopt;
      const double si = value ? wanted.columns[columns.wanted[i]].to_si(*value) : std::nan("");
      columns.values[i].push_back(std::isfinite(si) ? si : std::nan(""));
    }
  }

  std::string name_;
  std::vector<DbcMessage> messages_{};
  std::vector<LogColumn> columns_{};
  std::vector<Place> places_{};
  std::unique_ptr<CanFrames> frames_{};
};

}  // namespace

std::unique_ptr<LogSource> open_candump(OpenedLog log) {
  return std::make_unique<CanSource>(std::move(log), candump_frames);
}
std::unique_ptr<LogSource> open_asc(OpenedLog log) { return std::make_unique<CanSource>(std::move(log), asc_frames); }
std::unique_ptr<LogSource> open_blf(OpenedLog log) { return std::make_unique<CanSource>(std::move(log), blf_frames); }

}  // namespace steerid
