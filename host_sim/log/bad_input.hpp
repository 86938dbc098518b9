// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is wrong with something the user gave us, in one sentence that says where and what to do.
//
//   FILE, line N, column 'C': expected X, found "Y"; do Z
//
// Host libraries throw BadInput and nothing else for bad data; the command prints what() and exits with 1. A mistake
// in an option's text is BadOption instead, and exits with 2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace steerid {

/// `text` with \xNN for what is no printable UTF-8. A file's name may hold a line break or an escape sequence: it must
/// neither break a sentence into lines nor drive the terminal.
[[nodiscard]] std::string printable(std::string_view text);

/// Bad data: a file that is missing, unreadable or does not hold what it should. Exit code 1. The sentence is made
/// printable.
class BadInput : public std::runtime_error {
 public:
  explicit BadInput(std::string_view sentence) : std::runtime_error(printable(sentence)) {}
};

/// An option's text that cannot be understood. Exit code 2.
class BadOption : public std::invalid_argument {
 public:
  explicit BadOption(std::string_view sentence) : std::invalid_argument(printable(sentence)) {}
};

/// The parts of the sentence. A part that is left empty (a line of 0) is left out of it.
struct Complaint {
  std::string file{};
  std::size_t line = 0;    ///< counts from 1, as editors do
  std::string column{};    ///< the name in the header
  std::string expected{};  ///< "a number"
  std::string found{};     ///< "3 cells", or the text of the file through in_quotes()
  std::string advice{};    ///< "leave the cell empty where nothing was measured"
};

[[nodiscard]] BadInput bad_input(const Complaint& complaint);

/// `text` in quotes, printable, at most some 40 bytes of it.
[[nodiscard]] std::string in_quotes(std::string_view text, char quote = '"');

}  // namespace steerid
