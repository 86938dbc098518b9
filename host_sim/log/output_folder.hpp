// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a command puts its files. What is computed for long is of no use where it cannot be written: such a command
// finds that out first.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace steerid {

/// Makes `folder` and what is above it, where they are not there yet, and sees that a file can be made in it. Throws
/// BadInput when that cannot be done.
void make_output_folder(const std::filesystem::path& folder);

/// Makes `folder` and what is above it, where they are not there yet. Throws BadInput when that cannot be done.
void make_folders(const std::filesystem::path& folder);

/// Sees that `target` can be written as a WholeFile is, and leaves it as it was. Throws BadInput. Of a device or a pipe
/// nothing is asked: who reads a pipe would take the question for its end.
void check_output_file(const std::filesystem::path& target);

struct OutputFile {
  std::string name;
  std::string_view text;
};

/// Writes `files` into `folder`, which is made when needed. None takes its place before all are written. Throws
/// BadInput.
void write_together(const std::filesystem::path& folder, std::initializer_list<OutputFile> files);

}  // namespace steerid
