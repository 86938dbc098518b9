// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/recorder.hpp"

namespace steerid {

std::vector<std::unique_ptr<RecordEffect>> record_effects(std::span<const Effect> effects, const RunSetting& setting) {
  std::vector<std::unique_ptr<RecordEffect>> made;
  for (const Effect& effect : effects) {
    if (effect.type->on_record != nullptr) made.push_back(effect.type->on_record(effect.values, setting));
  }
  return made;
}

Recorder::Recorder(std::span<const Effect> effects, const RunSetting& setting)
    : effects_(record_effects(effects, setting)) {}

void Recorder::before_noise(Channels& sample) {
  for (const auto& effect : effects_) {
    if (!effect->converter()) effect->record(sample);
  }
}

void Recorder::after_noise(Channels& sample) {
  for (const auto& effect : effects_) {
    if (effect->converter()) effect->record(sample);
  }
}

}  // namespace steerid
