// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/put_in.hpp"

#include <fmt/format.h>

#include <functional>

namespace steerid {
namespace {

constexpr std::array kSymbols{"J", "B", "C"};
constexpr std::array kUnits{"kg m\u00b2", "Nms/rad", "Nm/rad"};

/// A parameter of one record: of the true arm, or of an answer that is valid.
using ParameterOf = std::function<std::optional<double>(std::size_t at, std::size_t parameter)>;

std::optional<double> true_parameter(const IdentifiedRecord& record, std::size_t parameter) {
  const WheelArm& arm = record.what.arm;
  return std::array{arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad}[parameter];
}

std::optional<double> found_parameter(const IdentifiedRecord& record, std::size_t parameter) {
  if (!record.batch.valid(static_cast<int>(parameter))) return std::nullopt;
  return record.batch.value[parameter];
}

struct Place {
  TaskKind task;
  HandPosition hands;
};

/// Of one parameter over all subjects, at `over` divided by `under`, for each pair of places.
Spread ratios(const ParameterOf& parameter_of, std::size_t parameter,
              const std::vector<std::pair<Place, Place>>& pairs) {
  std::vector<double> values;
  for (const auto& [over, under] : pairs) {
    for (std::size_t subject = 0; subject < kSubjects; ++subject) {
      const auto above = parameter_of(ExperimentRun::index(over.task, over.hands, subject), parameter);
      const auto below = parameter_of(ExperimentRun::index(under.task, under.hands, subject), parameter);
      if (above && below) values.push_back(*above / *below);
    }
  }
  return spread_of(std::move(values));
}

Spread range(const ParameterOf& parameter_of, std::size_t parameter, TaskKind task) {
  std::vector<double> values;
  for (const HandPosition hands : kAllHandPositions) {
    for (std::size_t subject = 0; subject < kSubjects; ++subject) {
      const auto value = parameter_of(ExperimentRun::index(task, hands, subject), parameter);
      if (value) values.push_back(*value);
    }
  }
  return spread_of(std::move(values));
}

std::vector<std::pair<Place, Place>> between_tasks() {
  std::vector<std::pair<Place, Place>> pairs;
  pairs.reserve(kAllHandPositions.size());
  for (const HandPosition hands : kAllHandPositions) {
    pairs.push_back({{TaskKind::kPassive, hands}, {TaskKind::kActive, hands}});
  }
  return pairs;
}

std::vector<std::pair<Place, Place>> between_arms() {
  std::vector<std::pair<Place, Place>> pairs;
  for (const TaskKind task : kSteeringTasks) {
    for (std::size_t grip = 0; grip < 3; ++grip) {
      pairs.push_back({{task, kAllHandPositions[grip + 3]}, {task, kAllHandPositions[grip]}});
    }
  }
  return pairs;
}

/// The grips other than the first over the first, right arm and both.
std::vector<std::pair<Place, Place>> between_grips(TaskKind task, std::size_t grip) {
  std::vector<std::pair<Place, Place>> pairs;
  for (const std::size_t arms : {0U, 3U}) {
    pairs.push_back({{task, kAllHandPositions[grip + arms]}, {task, kAllHandPositions[arms]}});
  }
  return pairs;
}

}  // namespace

std::vector<PutIn> put_in(const ExperimentRun& run) {
  const ParameterOf truth = [&](std::size_t at, std::size_t i) { return true_parameter(run.plain[at], i); };
  const ParameterOf plain = [&](std::size_t at, std::size_t i) { return found_parameter(run.plain[at], i); };
  const ParameterOf probed = [&](std::size_t at, std::size_t i) { return found_parameter(run.probed[at], i); };
  std::vector<PutIn> out;
  const auto add_ratios = [&](const std::string& what, const char* origin, std::size_t i, const auto& pairs) {
    out.push_back({fmt::format("{}, {}", kSymbols[i], what), "", origin, ratios(truth, i, pairs),
                   ratios(plain, i, pairs), ratios(probed, i, pairs)});
  };
  constexpr const char* kTables = "tables I and II";
  add_ratios("passive over active", "one arm for both tasks", 0, between_tasks());
  for (const std::size_t i : {1U, 2U}) add_ratios("passive over active", kTables, i, between_tasks());
  for (std::size_t i = 0; i < 3; ++i) add_ratios("both arms over one", "a factor of our own", i, between_arms());
  for (const TaskKind task : kSteeringTasks) {
    for (const std::size_t grip : {1U, 2U}) {
      add_ratios(fmt::format("{}, {} over 3 o'clock", name(task), grip == 1 ? "12" : "1:30"), kTables, 2,
                 between_grips(task, grip));
    }
  }
  for (const TaskKind task : kSteeringTasks) {
    for (std::size_t i = 0; i < 3; ++i) {
      out.push_back({fmt::format("{}, {} task", kSymbols[i], name(task)), kUnits[i], kTables, range(truth, i, task),
                     range(plain, i, task), range(probed, i, task)});
    }
  }
  return out;
}

}  // namespace steerid
