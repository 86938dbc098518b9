// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/case_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "blind/catalogue.hpp"
#include "log/csv_writer.hpp"
#include "log/output_folder.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid::blind {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }

Json effect_json(const DrawnEffect& effect) {
  Json parameters = Json::object();
  for (const auto& [name, value] : effect.numbers.all()) parameters[name] = value;
  return {{"effect", effect.id}, {"parameters", parameters}};
}

void write_case(const std::filesystem::path& folder, const DrawnCase& drawn) {
  make_output_folder(folder);
  CsvWriter log(folder / "log.csv", {"time_s", "torque_driver_nm", "torque_motor_nm", "angle_rad"});
  for (std::size_t i = 0; i < drawn.record.size(); ++i) {
    log.cell(drawn.record.time_s[i], 3)
        .cell(drawn.record.torque_driver_nm[i], 5)
        .cell(drawn.record.torque_motor_nm[i], 5)
        .cell(drawn.record.angle_rad[i], 6)
        .end_row();
  }
  log.commit();
  Json sim = {{"inertia_kgm2", rounded(drawn.simulation.inertia_kgm2, 1e-5)},
              {"damping_nms_per_rad", rounded(drawn.simulation.damping_nms_per_rad, 1e-4)},
              {"stiffness_nm_per_rad", rounded(drawn.simulation.stiffness_nm_per_rad, 1e-3)}};
  for (const DrawnEffect& effect : drawn.simulated) sim["effects"].push_back(effect_json(effect));
  write_whole_file(folder / "sim.json", sim.dump(1) + "\n");
}

Json arm_json(const Arm& arm) {
  return {{"inertia_kgm2", arm.inertia_kgm2},
          {"damping_nms_per_rad", arm.damping_nms_per_rad},
          {"stiffness_nm_per_rad", arm.stiffness_nm_per_rad}};
}

const char* change_word(Simulated how) {
  return how == Simulated::kNot ? "add" : how == Simulated::kResized ? "resize" : "remove";
}

Json answer(const DrawnCase& drawn) {
  Json effects = Json::array();
  Json parameters = Json::object();
  for (const DrawnEffect& effect : drawn.effects) {
    effects.push_back(effect.id);
    parameters[effect.id] = effect_json(effect)["parameters"];
  }
  Json changes = Json::array();
  for (const Content& one : drawn.contents) {
    if (one.simulated == Simulated::kAsItIs || !is_known(one.id)) continue;
    changes.push_back({{"effect", one.id}, {"change", change_word(one.simulated)}});
  }
  return {{"label", drawn.label},
          {"effects", effects},
          {"parameters", parameters},
          {"case", several_case(drawn.contents)},
          {"changes", changes},
          {"plant",
           {{"task", name(drawn.task)},
            {"duration_s", drawn.duration_s},
            {"arm", arm_json(drawn.arm)},
            {"wheel_inertia_share", drawn.wheel_inertia_share},
            {"wheel_damping_share", drawn.wheel_damping_share},
            {"driver_noise_nm", drawn.sensors.driver_noise_nm},
            {"angle_noise_rad", drawn.sensors.angle_noise_rad},
            {"unseen_rms_nm", drawn.unseen_rms_nm}}},
          {"ratio", drawn.gap_over_floor},
          {"floor_nrmse", drawn.floor_nrmse},
          {"refit_nrmse", drawn.refit_nrmse},
          {"sim", arm_json(drawn.simulation)},
          {"linear_fit", arm_json(drawn.linear_fit)}};
}

}  // namespace

std::string case_name(std::size_t number) { return fmt::format("case{:03}", number); }

std::uint64_t case_seed(std::uint64_t seed, std::size_t number) { return Draw(seed, 1000 + number).bits(); }

std::string draw_and_write(std::span<const Contents> contents, std::uint64_t seed, bool held,
                           const std::filesystem::path& cases, const std::function<void(std::size_t)>& done) {
  std::vector<Json> answers(contents.size());
  work_in_parallel(contents.size(), 0, done, [&](std::size_t i) {
    const DrawnCase drawn = draw_case(contents[i], case_seed(seed, i), held);
    write_case(cases / case_name(i), drawn);
    answers[i] = answer(drawn);
  });
  Json key = Json::object();
  for (std::size_t i = 0; i < answers.size(); ++i) key[case_name(i)] = std::move(answers[i]);
  return key.dump(1) + "\n";
}

}  // namespace steerid::blind
