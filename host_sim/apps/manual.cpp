// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <sstream>
#include <vector>

#include "apps/commands.hpp"
#include "apps/option_kinds.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

/// Text as man(7) takes it: a backslash is \e, a dash a real one, and no line begins with a dot or a quote.
std::string roff(const std::string& text) {
  std::string out;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
    begins = c == '\n';
  }
  return out;
}

std::string names_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += fmt::format("{}-{}", names.empty() ? "" : ", ", name);
  for (const std::string& name : option.get_lnames()) names += fmt::format("{}--{}", names.empty() ? "" : ", ", name);
  return names.empty() ? option.get_name() : names;
}

/// What follows the option: the words it takes, or what its type is called.
std::string value_of(const CLI::Option& option) {
  if (option.get_type_size_max() == 0) return "";
  const std::vector<std::string> words = words_of(option);
  return words.empty() ? option.get_type_name().substr(0, option.get_type_name().find(':'))
                       : fmt::format("{}", fmt::join(words, "|"));
}

/// Of a command and those below it, each with its words from "steerid" on.
template <class Do>
void each_command(const CLI::App& app, const std::string& words, Do&& work) {
  work(app, words);
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; })) {
    each_command(*below, words + " " + below->get_name(), work);
  }
}

void add_options(const CLI::App& command, std::string& page) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string value = option->get_positional() ? "" : value_of(*option);
    page += fmt::format(".TP\n.B {}{}\n{}\n", roff(names_of(*option)), value.empty() ? "" : " " + roff(value),
                        roff(option->get_description()));
    if (!option->get_default_str().empty()) page += fmt::format("Default: {}.\n", roff(option->get_default_str()));
  }
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string page =
      fmt::format(".TH STEERID 1 \"\" \"steerid {}\" \"User Commands\"\n.SH NAME\nsteerid \\- {}\n", STEERID_VERSION,
                  "inertia, damping and stiffness of a driver's arm on a steering wheel");
  page += ".SH SYNOPSIS\n.B steerid\n.I COMMAND\n[OPTIONS]\n.SH DESCRIPTION\n" + roff(app.get_description()) + "\n";
  each_command(app, "steerid", [&](const CLI::App& command, const std::string& words) {
    if (&command == &app) return;
    page += fmt::format(".SH {}\n{}.\n", roff(words), roff(command.get_description()));
    add_options(command, page);
    if (!command.get_footer().empty()) page += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command.get_footer()));
  });
  return page + ".SH EXIT STATUS\n" + roff(app.get_footer()) + "\n";
}

std::string bash_completion(const CLI::App& app) {
  std::string commands;
  std::string values;
  each_command(app, "steerid", [&](const CLI::App& command, const std::string& words) {
    std::vector<std::string> offered;
    for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
      offered.push_back(below->get_name());
    }
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) {
        offered.push_back("--" + name);
        if (const auto among = words_of(*option); !among.empty()) {
          values += fmt::format("    '{} --{}') offered='{}' ;;\n", words, name, fmt::join(among, " "));
        } else if (kind_of(*option) == OptionKind::kFolder) {
          values += fmt::format("    '{} --{}') files=-d ;;\n", words, name);
        } else if (kind_of(*option) == OptionKind::kFile) {
          values += fmt::format("    '{} --{}') files=-f ;;\n", words, name);
        } else if (kind_of(*option) != OptionKind::kFlag) {
          values += fmt::format("    '{} --{}') return ;;\n", words, name);
        }
      }
      if (option->get_positional()) {
        for (const std::string& word : words_of(*option)) offered.push_back(word);
      }
    }
    commands += fmt::format("    '{}') offered='{}' ;;\n", words, fmt::join(offered, " "));
  });
  return fmt::format(
      R"(# Completion of the steerid command for bash, made by `steerid completion`.
_steerid() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command=steerid offered='' files='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    [[ ${{COMP_WORDS[i]}} != -* ]] && _steerid_is_command "$command ${{COMP_WORDS[i]}}" &&
      command="$command ${{COMP_WORDS[i]}}"
  done
  case "$command $before" in
{}  esac
  if [[ -z $offered && -z $files ]]; then
    case $command in
{}    esac
    [[ $word == -* ]] || files=-f
  fi
  mapfile -t COMPREPLY < <(compgen -W "$offered" -- "$word"; [[ -n $files ]] && compgen $files -- "$word")
}}
_steerid_is_command() {{
  local offered
  case $1 in
{}    *) return 1 ;;
  esac
}}
complete -o filenames -F _steerid steerid
)",
      values, commands, commands);
}

namespace {

/// A command that writes what is made from all options to --out.
void add_made(CLI::App& app, const std::string& name, const std::string& says,
              std::string (*make)(const CLI::App& app)) {
  CLI::App* command = app.add_subcommand(name, says);
  auto out = std::make_shared<std::filesystem::path>("-");
  writes_file(command->add_option("--out", *out, "Where it goes; - for standard output"))
      ->type_name("FILE")
      ->capture_default_str();
  runs(*command, [&app, out, make](FilesOfRun&) { write_whole_file(*out, make(app)); });
}

}  // namespace

void add_manual(CLI::App& app) {
  add_made(app, "manual", "The manual page steerid(1), for man -l", manual_page);
  add_made(app, "completion", "Completion of commands and options for bash", bash_completion);
}

}  // namespace steerid
