// Where a command that writes several files puts them.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace steerid {

/// Makes `folder` and what is above it, where they are not there yet. Throws BadInput when that cannot be done.
void make_output_folder(const std::filesystem::path& folder);

struct OutputFile {
  std::string name;
  std::string_view text;
};

/// Writes `files` into `folder`, which is made when needed. None takes its place before all are written. Throws
/// BadInput.
void write_together(const std::filesystem::path& folder, std::initializer_list<OutputFile> files);

}  // namespace steerid
