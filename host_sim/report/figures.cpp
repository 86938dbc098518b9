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
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
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

/// A folder that goes with all that is in it.
class Scratch {
 public:
  explicit Scratch(fs::path folder) : folder_(std::move(folder)) { fs::create_directory(folder_); }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

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
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), program);
  }
  if (status != 0) throw std::runtime_error("node could not draw the figures");
}

void draw(const fs::path& folder, const std::string& document) {
  const std::string program = node();
  make_output_folder(folder);
  const Scratch scratch(folder / fmt::format(".figures.partial-{}", ::getpid()));
  const fs::path script = scratch.folder() / "figures.cjs";
  const fs::path source = scratch.folder() / "document.json";
  const fs::path drawn = scratch.folder() / "drawn";
  write_whole_file(script, figures_bundle());
  write_whole_file(source, document);
  fs::create_directory(drawn);
  run_node(program, script, source, drawn);
  for (const auto& entry : fs::directory_iterator(drawn)) fs::rename(entry.path(), folder / entry.path().filename());
}

}  // namespace

void require_node() { (void)node(); }

void write_figures(const fs::path& folder, const Page& page) { draw(folder, document_json(page)); }

void write_figures_of(const fs::path& page, const fs::path& folder) {
  constexpr std::string_view kBegin = R"(<script type="application/json" id="document">)";
  constexpr std::string_view kEnd = "</script>";
  std::ifstream in(page, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t begin = text.find(kBegin);
  const std::size_t end = begin == std::string::npos ? begin : text.find(kEnd, begin);
  if (end == std::string::npos) throw std::runtime_error(page.string() + " is no page");
  draw(folder, text.substr(begin + kBegin.size(), end - begin - kBegin.size()));
}

}  // namespace steerid::report
