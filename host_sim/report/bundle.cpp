// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The bundles' bytes are put into this object file by the assembler: a compiler takes seconds over an array of 0.7 MB.
#include "report/bundle.hpp"

// clang-format off
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".global steerid_report_bundle_begin, steerid_report_bundle_end\n"
    ".hidden steerid_report_bundle_begin, steerid_report_bundle_end\n"
    "steerid_report_bundle_begin:\n"
    ".incbin \"" STEERID_REPORT_BUNDLE "\"\n"
    "steerid_report_bundle_end:\n"
    ".byte 0\n"
    ".global steerid_report_figures_begin, steerid_report_figures_end\n"
    ".hidden steerid_report_figures_begin, steerid_report_figures_end\n"
    "steerid_report_figures_begin:\n"
    ".incbin \"" STEERID_REPORT_FIGURES "\"\n"
    "steerid_report_figures_end:\n"
    ".byte 0\n"
    ".previous\n");
// clang-format on

extern "C" {
extern const char steerid_report_bundle_begin[];
extern const char steerid_report_bundle_end[];
extern const char steerid_report_figures_begin[];
extern const char steerid_report_figures_end[];
}

namespace steerid::report {

std::string_view page_bundle() {
  return {steerid_report_bundle_begin,
          static_cast<std::size_t>(steerid_report_bundle_end - steerid_report_bundle_begin)};
}

std::string_view figures_bundle() {
  return {steerid_report_figures_begin,
          static_cast<std::size_t>(steerid_report_figures_end - steerid_report_figures_begin)};
}

}  // namespace steerid::report
