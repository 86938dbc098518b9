// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Several records of one wheel, diagnosed together: one set of changes, the evidence of all records added, and what
// differs between the records.
//
// A number differs where its values, each with the deviation that its record leaves, are further apart than one value
// for all of them explains: chi^2 over the records less one, at 1 %. J, B and C of different drivers' arms differ as a
// rule; a size of the wheel's own that does says that the wheel was changed, warmed up, or is loaded otherwise.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid::gap {

struct NamedRecord {
  std::string name;  ///< for sentences: its file's
  Record record;
};

/// One number of the wheel or of a change, in all records.
struct SharedNumber {
  std::string of;                    ///< "wheel", or the effect's id
  std::string parameter;             ///< "inertia_kgm2", "friction_nm"
  std::vector<BoundedValue> values;  ///< one a record
  BoundedValue together;             ///< weighted by what the records say; it holds where nothing differs
  bool differs = false;
};

struct Together {
  std::vector<Diagnosis> records;     ///< with the same changes, each with its own sizes
  std::vector<SharedNumber> numbers;  ///< J, B, C, then those of the changes that are named
};

/// Two records or more. Throws BadInput, the record's name in front, where one of them cannot tell anything.
[[nodiscard]] Together diagnose_together(std::span<const NamedRecord> records, const Simulation& simulation,
                                         const DiagnoseOptions& options = {});

/// Makes the interval of a size that was taken from all records no narrower than what their own ones, each as wide as
/// its record's misfit makes it, come to together. The diagnoses name the same changes.
void widen_shared_sizes(std::span<Diagnosis> records);

/// What is the same and what differs; the diagnoses name the same changes.
[[nodiscard]] std::vector<SharedNumber> shared_numbers(std::span<const Diagnosis> records);

/// "stiffness_nm_per_rad of the wheel differs: 22.7 in a.csv, 31.2 in b.csv"
[[nodiscard]] std::string difference_words(const SharedNumber& number, std::span<const NamedRecord> records);

}  // namespace steerid::gap
