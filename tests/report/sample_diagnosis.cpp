// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes the page of a diagnosis that the browser test opens: of a drawn record with dry friction.
//
//   report_sample_diagnosis FOLDER
#include <cstdio>
#include <filesystem>

#include "apps/diagnosis_page.hpp"
#include "blind/drawn_case.hpp"

int main(int count, char** words) {
  if (count != 2) {
    (void)std::fputs("usage: report_sample_diagnosis FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = words[1];
  std::filesystem::create_directories(folder);
  const steerid::blind::DrawnCase drawn = steerid::blind::draw_case({"coulomb_friction"}, 12);
  steerid::Simulation given;
  given.wheel = {drawn.simulation.inertia_kgm2, drawn.simulation.damping_nms_per_rad,
                 drawn.simulation.stiffness_nm_per_rad};
  const steerid::gap::Diagnosis diagnosis = steerid::gap::diagnose(drawn.record, given);
  steerid::report::write_page(folder / "diagnosis.html",
                              steerid::diagnosis_page({"drive.csv", "sim.json", diagnosis, given}));
}
