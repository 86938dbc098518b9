// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fleet/shard_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>
#include <utility>

#include "log/bad_input.hpp"
#include "log/input_file.hpp"

namespace steerid::fleet {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "steerid.shard/1";
constexpr std::size_t kBlockBytes = std::size_t{1} << 18;

std::string one_line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

const char* name(Ended ended) {
  switch (ended) {
    case Ended::kAnswered:
      return "answered";
    case Ended::kUnusable:
      return "unusable";
    case Ended::kFault:
      return "fault";
  }
  return "fault";
}

Ended ended_of(const std::string& text) {
  for (const Ended one : {Ended::kAnswered, Ended::kUnusable, Ended::kFault}) {
    if (text == name(one)) return one;
  }
  throw std::invalid_argument("no way to end");
}

ShardHeader header_of(const Json& json) {
  if (json.at("schema") != kSchema) throw std::invalid_argument("another schema");
  return {.command = json.at("command").get<std::string>(),
          .program = json.at("program").get<std::string>(),
          .options = json.at("options"),
          .shard = {json.at("shard").get<std::size_t>(), json.at("of").get<std::size_t>()},
          .records = json.at("records").get<std::size_t>(),
          .records_in_all = json.at("records_in_all").get<std::size_t>(),
          .list_sha256 = json.at("list_sha256").get<std::string>()};
}

RecordLine line_of(Json json) {
  RecordLine line;
  line.record.name = json.at("record").get<std::string>();
  line.record.log = json.at("log").get<std::string>();
  line.record.vehicle = json.value("vehicle", "");
  line.record.date = json.value("date", "");
  if (json.contains("mileage_km")) line.record.mileage_km = json.at("mileage_km").get<double>();
  line.ended = ended_of(json.at("ended").get<std::string>());
  line.error = json.value("error", "");
  line.made_from = std::move(json.at("made_from"));
  line.answer = std::move(json.at("answer"));
  if (line.answer.is_null() == (line.ended == Ended::kAnswered)) throw std::invalid_argument("an answer that is none");
  return line;
}

}  // namespace

std::string to_line(const ShardHeader& header) {
  return one_line({{"schema", kSchema},
                   {"command", header.command},
                   {"program", header.program},
                   {"options", header.options},
                   {"shard", header.shard.number},
                   {"of", header.shard.of},
                   {"records", header.records},
                   {"records_in_all", header.records_in_all},
                   {"list_sha256", header.list_sha256}});
}

std::string shard_file_name(const Shard& shard) { return fmt::format("shard_{}_of_{}.jsonl", shard.number, shard.of); }

std::string to_line(const RecordLine& line) {
  Json json = {{"record", line.record.name}, {"log", line.record.log}};
  if (!line.record.vehicle.empty()) json["vehicle"] = line.record.vehicle;
  if (!line.record.date.empty()) json["date"] = line.record.date;
  if (line.record.mileage_km) json["mileage_km"] = *line.record.mileage_km;
  json["ended"] = name(line.ended);
  if (!line.error.empty()) json["error"] = line.error;
  json["made_from"] = line.made_from;
  json["answer"] = line.answer;
  return one_line(json);
}

ShardReader::ShardReader(std::filesystem::path file) : file_(std::move(file)) {
  std::string text;
  try {
    if (!next_text(text)) complain("the table of a shard", "an empty file");
    header_ = header_of(Json::parse(text));
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception&) {
    complain("the table of a shard, as --shard writes it", in_quotes(text));
  }
}

bool ShardReader::next(RecordLine& line) {
  std::string text;
  if (!next_text(text)) {
    if (number_ != header_.records + 1) {
      complain(fmt::format("{} records", header_.records), fmt::format("{}", number_ - 1));
    }
    return false;
  }
  try {
    line = line_of(Json::parse(text));
  } catch (const std::exception&) {
    complain("a record of a shard", in_quotes(text));
  }
  return true;
}

bool ShardReader::next_text(std::string& text) {
  for (;;) {
    const std::size_t end = block_.find('\n', at_);
    if (end != std::string::npos) {
      text = block_.substr(at_, end - at_);
      at_ = end + 1;
      ++number_;
      return true;
    }
    block_.erase(0, at_);
    at_ = 0;
    const std::size_t held = block_.size();
    if (held > kMostBytesOfJson) complain("lines of at most 16 MiB", "a longer one");
    std::ifstream in(file_, std::ios::binary);
    if (!in.seekg(static_cast<std::streamoff>(offset_))) complain("a readable file", "none");
    block_.resize(held + kBlockBytes);
    in.read(block_.data() + held, kBlockBytes);
    const auto got = static_cast<std::size_t>(in.gcount());
    block_.resize(held + got);
    offset_ += got;
    if (got > 0) continue;
    if (held > 0) complain("a line feed at the end", "a line that is cut off");
    return false;
  }
}

void ShardReader::complain(const std::string& expected, const std::string& found) const {
  throw bad_input({.file = file_.string(),
                   .line = number_,
                   .expected = expected,
                   .found = found,
                   .advice = "remove it and run its shard again"});
}

}  // namespace steerid::fleet
