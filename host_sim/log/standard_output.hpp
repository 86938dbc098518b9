// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Standard output as a place that can be full, that can be closed, and that may be wanted for a file.
//
// Commands print for people to stdout. Where a file is to be written to standard output ("-"), what is printed for
// people goes to standard error in its place, so that the file stands alone; where nothing is to be printed, nowhere.
// Descriptor 1 is what is turned round: started processes follow.
#pragma once

namespace steerid {

/// What is printed from here on goes to standard error; standard output is for a file.
void keep_standard_output_for_a_file();

/// What is printed from here on goes nowhere, and no progress is shown; a file can be written to standard output all
/// the same.
void print_nothing();
[[nodiscard]] bool prints_nothing();

/// A new descriptor of what standard output was when the program began, behind all that was printed. -1 with errno set
/// when there is none.
[[nodiscard]] int open_standard_output();

/// Brings what was printed where it belongs. Throws BadInput when that is not possible, ReaderGone when it is a pipe
/// that nobody reads any more.
void finish_printing();

/// Not a fault: whoever read what the program writes has seen enough (`steerid ... | head`).
struct ReaderGone {};

}  // namespace steerid
