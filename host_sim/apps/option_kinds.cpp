// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/option_kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "log/bad_input.hpp"
#include "log/nearest_word.hpp"
#include "log/standard_output.hpp"

namespace steerid {
namespace {

// Validators are what an option keeps; their names tell the kinds apart.
constexpr const char* kNumber = "number";
constexpr const char* kWord = "word";
constexpr const char* kReads = "file that is read";
constexpr const char* kReadsFolder = "folder that is read";
constexpr const char* kWrites = "file that is written";
constexpr const char* kWritesFolder = "folder that is written";

/// The option's validator of that name; null when it has none.
const CLI::Validator* find(const CLI::Option& option, const char* name) {
  try {
    return const_cast<CLI::Option&>(option).get_validator(name);  // it looks only
  } catch (const CLI::OptionNotFound&) {
    return nullptr;
  }
}

template <class Number>
bool read_all(std::string_view text, Number& number) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && stop == text.data() + text.size();
}

CLI::Option* mark(CLI::Option* option, const char* kind) {
  return option->check(CLI::Validator([](std::string&) { return std::string(); }, "", kind));
}

std::string bound(std::uint64_t number) {
  return number == std::numeric_limits<std::uint64_t>::max() ? "2^64 - 1" : std::to_string(number);
}

/// What `take` makes of the files that the options of such a kind name, here and in the commands above and below.
void each_file(const CLI::App& command, const char* kind, const std::function<void(std::string, std::string)>& take) {
  const auto of_one = [&](const CLI::App& one) {
    for (const CLI::Option* option : one.get_options()) {
      if (find(*option, kind) == nullptr) continue;
      for (const std::string& file : option->results()) take(file, option->get_name());
    }
  };
  for (const CLI::App* above = &command; above != nullptr; above = above->get_parent()) of_one(*above);
  for (auto below = command.get_subcommands(); !below.empty(); below = below.front()->get_subcommands()) {
    of_one(*below.front());
  }
}

}  // namespace

bool is_number_from(std::string_view text, double low, double high) {
  double number = 0.0;
  return read_all(text, number) && number >= low && number <= high;  // a nan is in no range
}

CLI::Option* number_from(CLI::Option* option, double low, double high) {
  return option->check(CLI::Validator(
      [low, high](std::string& text) {
        if (is_number_from(text, low, high)) return std::string();
        return fmt::format("expected a number from {:g} to {:g}, found {}", low, high, in_quotes(text));
      },
      "", kNumber));
}

CLI::Option* whole_from(CLI::Option* option, std::uint64_t low, std::uint64_t high) {
  // The text becomes what was understood: the library would take 010 for eight.
  return option->transform(CLI::Validator(
      [low, high](std::string& text) {
        std::uint64_t number = 0;
        if (!read_all(text, number) || number < low || number > high) {
          return fmt::format("expected a whole number from {} to {}, found {}", low, bound(high), in_quotes(text));
        }
        text = std::to_string(number);
        return std::string();
      },
      "", kNumber));
}

CLI::Option* one_of(CLI::Option* option, std::vector<std::string> words) {
  const std::string all = fmt::format("{}", fmt::join(words, ","));
  return option->check(CLI::Validator(
      [words = std::move(words)](std::string& text) {
        if (std::ranges::find(words, text) != words.end()) return std::string();
        return fmt::format("expected one of {}, found {}{}", fmt::join(words, ", "), in_quotes(text),
                           did_you_mean(text, words));
      },
      all, kWord));
}

CLI::Option* reads_file(CLI::Option* option) { return mark(option, kReads); }
CLI::Option* reads_folder(CLI::Option* option) { return mark(option, kReadsFolder); }
CLI::Option* writes_file(CLI::Option* option) { return mark(option, kWrites); }

CLI::Option* writes_folder(CLI::Option* option) { return mark(option, kWritesFolder); }

OptionKind kind_of(const CLI::Option& option) {
  if (option.get_type_size_max() == 0) return OptionKind::kFlag;
  if (find(option, kNumber) != nullptr) return OptionKind::kNumber;
  if (find(option, kWord) != nullptr) return OptionKind::kWord;
  if (find(option, kReads) != nullptr || find(option, kWrites) != nullptr) return OptionKind::kFile;
  if (find(option, kReadsFolder) != nullptr || find(option, kWritesFolder) != nullptr) return OptionKind::kFolder;
  return OptionKind::kText;
}

std::vector<std::string> words_of(const CLI::Option& option) {
  const CLI::Validator* words = find(option, kWord);
  return words == nullptr ? std::vector<std::string>() : CLI::detail::split(words->get_description(), ',');
}

void add_quiet(CLI::App& command) { command.add_flag_callback("--quiet", print_nothing, "Print nothing but errors"); }

void runs(CLI::App& command, std::function<void(FilesOfRun&)> work) {
  add_quiet(command);
  command.callback([&command, work = std::move(work)] {
    FilesOfRun files;
    each_file(command, kReads, [&](const auto& file, const auto& by) { files.reads(file, by); });
    each_file(command, kWrites, [&](const auto& file, const auto& by) { files.writes(file, by); });
    if (files.writes_standard_output()) keep_standard_output_for_a_file();
    work(files);
  });
}

}  // namespace steerid
