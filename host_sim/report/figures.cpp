// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/figures.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <list>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/unfinished_files.hpp"
#include "log/whole_file.hpp"
#include "report/bundle.hpp"

namespace steerid::report {
namespace {

namespace fs = std::filesystem;

/// Debian's name, and that of those who had it first.
constexpr std::array kNames = {"node", "nodejs"};

std::string node() {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : kNames) {
      std::string file = folder + "/" + name;
      if (::access(file.c_str(), X_OK) == 0) return file;
    }
  }
  throw BadInput("--figures: expected node in PATH, found none; install it (Debian: apt-get install nodejs)");
}

/// node SCRIPT DOCUMENT FOLDER; what it prints goes nowhere, and what it complains of where this program's does.
void run_node(const std::string& program, const fs::path& script, const fs::path& document, const fs::path& folder) {
  std::vector<std::string> words = {program, script.string(), document.string(), folder.string()};
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), program);
  const EndsWithProgram with_this_one(child);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), program);
  }
  if (status == 0) return;
  throw bad_input({.file = folder.string(),
                   .expected = "room, and a node that draws the figures",
                   .found = WIFEXITED(status) ? fmt::format("one that ended with {}", WEXITSTATUS(status))
                                              : fmt::format("one that was ended by signal {}", WTERMSIG(status)),
                   .advice = "free the disk, or look at what it said"});
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// None takes its place before all are written.
void draw(const fs::path& folder, const std::string& document, const ClaimFile& claim) {
  const std::string program = node();
  make_output_folder(folder);
  const ScratchFolder scratch(folder / fmt::format(".figures.partial-{}", ::getpid()));
  const fs::path script = scratch.path() / "figures.cjs";
  const fs::path source = scratch.path() / "document.json";
  const fs::path drawn = scratch.path() / "drawn";
  write_whole_file(script, figures_bundle());
  write_whole_file(source, document);
  fs::create_directory(drawn);
  run_node(program, script, source, drawn);
  std::list<WholeFile> figures;
  for (const auto& entry : fs::directory_iterator(drawn)) {
    const fs::path target = folder / entry.path().filename();
    claim(target);
    figures.emplace_back(target).write(text_of(entry.path()));
  }
  for (WholeFile& figure : figures) figure.commit();
}

/// A disk without room for a folder is bad data to whoever waits for the figures, no fault of this program.
void draw_or_complain(const fs::path& folder, const std::string& document, const ClaimFile& claim) {
  try {
    draw(folder, document, claim);
  } catch (const fs::filesystem_error& error) {
    throw bad_input({.file = folder.string(),
                     .expected = "a folder in which figures can be drawn",
                     .found = in_quotes(error.code().message()),
                     .advice = "choose another place or free this one"});
  }
}

}  // namespace

void require_node() { (void)node(); }

void write_figures(const fs::path& folder, const Page& page, const ClaimFile& claim) {
  draw_or_complain(folder, document_json(page), claim);
}

void write_figures_of(const fs::path& page, const fs::path& folder, const ClaimFile& claim) {
  constexpr std::string_view kBegin = R"(<script type="application/json" id="document">)";
  constexpr std::string_view kEnd = "</script>";
  const std::string text = text_of(page);
  const std::size_t begin = text.find(kBegin);
  const std::size_t end = begin == std::string::npos ? begin : text.find(kEnd, begin);
  if (end == std::string::npos) throw std::runtime_error(page.string() + " is no page");
  draw_or_complain(folder, text.substr(begin + kBegin.size(), end - begin - kBegin.size()), claim);
}

}  // namespace steerid::report
