// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/mcap_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "log/bad_input.hpp"
#include "log/foreign_file.hpp"
#include "log/mcap_reader.hpp"
#include "log/message_numbers.hpp"
#include "log/stamp_limits.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMessagesToJudgeBy = 100;  // of a topic
constexpr std::size_t kMostColumns = 10'000;
constexpr std::size_t kMostBytesOfPipe = std::size_t{256} << 20;
constexpr std::array<std::string_view, 3> kStamps = {"header/stamp", "stamp", "timestamp"};
constexpr std::array<std::string_view, 2> kByMcapCat = {"ros1", "protobuf"};  // encodings that `mcap cat` decodes
constexpr std::array<std::string_view, 2> kNanoseconds = {"nanosec", "nsec"};

/// How a channel's messages are read; null where they are not.
std::unique_ptr<MessageNumbers> numbers_of(const McapChannel& channel) {
  if (channel.encoding == "json") return json_numbers();
  if (channel.encoding == "cdr" && channel.schema.encoding == "ros2msg") {
    return ros2_numbers(channel.schema.name, channel.schema.text);
  }
  return nullptr;
}

/// A stream that can be wound back.
std::unique_ptr<std::istream> windable(std::unique_ptr<std::istream> in, const std::string& name) {
  if (in->seekg(0)) return in;
  in->clear();
  std::string bytes;
  constexpr std::size_t kStep = std::size_t{1} << 20;
  while (*in && bytes.size() <= kMostBytesOfPipe) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kStep);
    in->read(bytes.data() + before, static_cast<std::streamsize>(kStep));
    bytes.resize(before + static_cast<std::size_t>(in->gcount()));
  }
  if (bytes.size() > kMostBytesOfPipe) {
    throw bad_input({.file = name,
                     .expected = "an MCAP file of 256 MiB or less from a pipe",
                     .found = "more",
                     .advice = "name the file itself, which is read twice"});
  }
  return std::make_unique<std::istringstream>(std::move(bytes));
}

class McapSource final : public LogSource {
 public:
  explicit McapSource(OpenedLog log) : in_(windable(std::move(log.in), log.name)), name_(std::move(log.name)) {
    find_columns();
  }

  [[nodiscard]] const std::vector<LogColumn>& columns() const override { return columns_; }
  [[nodiscard]] bool time_is_a_column() const override { return false; }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

  [[nodiscard]] std::vector<StampedColumns> read(const Wanted& wanted) override {
    in_->clear();
    in_->seekg(0);
    McapReader reader(*in_, name_);
    std::map<std::string, Rows> rows = rows_of(wanted);
    std::map<std::uint16_t, std::unique_ptr<MessageNumbers>> numbers;
    for (McapMessage message; reader.next(message);) {
      const McapChannel& channel = reader.channel(message.channel);
      const auto found = rows.find(channel.topic);
      if (found == rows.end()) continue;
      auto [made, first] = numbers.try_emplace(message.channel);
      if (first) made->second = numbers_of(channel);
      if (made->second) take(found->second, message, *made->second, wanted);
    }
    if (reader.cut()) notes_.push_back("the file was not finished by its recorder: read up to its end");
    std::vector<StampedColumns> all;
    for (auto& [topic, one] : rows) {
      if (one.unreadable > 0) {
        notes_.push_back(
            fmt::format("{} messages of {} are not as their schema says: left out", one.unreadable, printable(topic)));
      }
      all.push_back(in_order(topic, std::move(one)));
    }
    return all;
  }

 private:
  struct Place {
    std::string topic;
    std::string path;
  };

  /// The wanted columns of one topic.
  struct Rows {
    StampedColumns columns{};
    std::map<std::string, std::size_t, std::less<>> index_of{};  ///< of a path: into columns.values
    std::vector<std::uint64_t> log_ns{};
    std::size_t unreadable = 0;
  };

  /// The message's own stamp as it is met among its numbers.
  struct Stamp {
    double seconds = 0;
    double nanoseconds = 0;
    bool whole = false;

    void take(std::string_view path, double value) {
      const std::size_t slash = path.rfind('/');
      if (slash == std::string_view::npos || std::ranges::count(kStamps, path.substr(0, slash)) == 0) return;
      const std::string_view field = path.substr(slash + 1);
      if (field == "sec") seconds = value;
      if (std::ranges::count(kNanoseconds, field) == 0) return;
      nanoseconds = value;
      whole = true;
    }
    [[nodiscard]] std::optional<double> time_s() const {
      if (!whole || (seconds == 0 && nanoseconds == 0)) return std::nullopt;  // a sender without a clock
      return seconds + nanoseconds / 1e9;
    }
  };

  void find_columns() {
    McapReader reader(*in_, name_);
    std::map<std::uint16_t, std::unique_ptr<MessageNumbers>> numbers;
    std::map<std::string, std::size_t> seen;
    std::set<std::string> unread;
    std::string convertible;  // a topic
    std::set<std::pair<std::string, std::string>> known;
    for (McapMessage message; reader.next(message);) {
      const McapChannel& channel = reader.channel(message.channel);
      auto [made, first] = numbers.try_emplace(message.channel);
      if (first) {
        made->second = numbers_of(channel);
        if (!made->second) unread.insert(unread_words(channel));
        const bool by_others = std::ranges::count(kByMcapCat, channel.encoding) > 0;
        if (!made->second && convertible.empty() && by_others) convertible = channel.topic;
      }
      if (!made->second || seen[channel.topic]++ >= kMessagesToJudgeBy) continue;
      (void)made->second->read(message.data, [&](std::string_view path, double) {
        if (columns_.size() >= kMostColumns || !known.emplace(channel.topic, path).second) return;
        columns_.push_back({.name = channel.topic + "/" + std::string(path)});
        places_.push_back({channel.topic, std::string(path)});
      });
    }
    if (columns_.empty()) {
      throw bad_input({.file = name_,
                       .expected = "messages with numbers, in JSON or in ROS 2's CDR with their definition",
                       .found = unread.empty() ? "none" : fmt::format("{}", fmt::join(unread, ", ")),
                       .advice = convertible.empty()
                                     ? "record such topics, or export the others as CSV, as PlotJuggler does"
                                     : "convert it with " + mcap_to_csv(name_, convertible)});
    }
    if (!unread.empty()) notes_.push_back(fmt::format("not read: {}", fmt::join(unread, ", ")));
  }

  static std::string unread_words(const McapChannel& channel) {
    return printable(fmt::format("{} ({} with schema {})", channel.topic,
                                 channel.encoding.empty() ? "no encoding" : channel.encoding,
                                 channel.schema.encoding.empty() ? "none" : channel.schema.encoding));
  }

  [[nodiscard]] std::map<std::string, Rows> rows_of(const Wanted& wanted) const {
    std::map<std::string, Rows> rows;
    for (std::size_t i = 0; i < wanted.columns.size(); ++i) {
      const Place& place = places_.at(wanted.columns[i].column);
      Rows& one = rows[place.topic];
      one.index_of[place.path] = one.columns.values.size();
      one.columns.wanted.push_back(i);
      one.columns.values.emplace_back();
    }
    return rows;
  }

  void take(Rows& rows, const McapMessage& message, const MessageNumbers& numbers, const Wanted& wanted) const {
    StampedColumns& columns = rows.columns;
    std::vector<double> row(columns.values.size(), std::numeric_limits<double>::quiet_NaN());
    Stamp stamp;
    const bool whole = numbers.read(message.data, [&](std::string_view path, double value) {
      stamp.take(path, value);
      const auto found = rows.index_of.find(path);
      if (found == rows.index_of.end()) return;
      const double si = wanted.columns[columns.wanted[found->second]].to_si(value);
      if (std::isfinite(si)) row[found->second] = si;
    });
    if (!whole) {
      ++rows.unreadable;
      return;
    }
    const double sent_s = static_cast<double>(message.publish_ns == 0 ? message.log_ns : message.publish_ns) / 1e9;
    const double time_s = stamp.time_s().value_or(sent_s);
    if (!(std::abs(time_s) <= kLatestTimeS)) {
      throw bad_input({.file = name_,
                       .expected = fmt::format("stamps within {:g} s of zero", kLatestTimeS),
                       .found = fmt::format("{} s", time_s),
                       .advice = "check the clock that stamped the messages"});
    }
    columns.time_s.push_back(time_s);
    rows.log_ns.push_back(message.log_ns);
    for (std::size_t i = 0; i < row.size(); ++i) columns.values[i].push_back(row[i]);
  }

  /// By when they were recorded: a file may hold its messages in any order.
  [[nodiscard]] StampedColumns in_order(const std::string& topic, Rows rows) const {
    StampedColumns& columns = rows.columns;
    if (!std::ranges::is_sorted(rows.log_ns)) {
      std::vector<std::size_t> order(rows.log_ns.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::ranges::stable_sort(order, {}, [&](std::size_t i) { return rows.log_ns[i]; });
      const auto reorder = [&](std::vector<double>& values) {
        std::vector<double> sorted;
        sorted.reserve(values.size());
        for (const std::size_t i : order) sorted.push_back(values[i]);
        values = std::move(sorted);
      };
      reorder(columns.time_s);
      for (std::vector<double>& values : columns.values) reorder(values);
    }
    const auto back = std::ranges::adjacent_find(columns.time_s, std::ranges::greater());
    if (back != columns.time_s.end()) {
      throw bad_input({.file = name_,
                       .column = topic,
                       .expected = fmt::format("a stamp after {} s", *back),
                       .found = fmt::format("{} s", *(back + 1)),
                       .advice = "split the file where its clock goes back"});
    }
    return std::move(columns);
  }

  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::vector<LogColumn> columns_{};
  std::vector<Place> places_{};
  std::vector<std::string> notes_{};
};

}  // namespace

std::unique_ptr<LogSource> open_mcap(OpenedLog log) { return std::make_unique<McapSource>(std::move(log)); }

}  // namespace steerid
