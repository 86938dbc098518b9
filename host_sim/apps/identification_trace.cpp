#include "apps/identification_trace.hpp"

#include "apps/identification.hpp"
#include "log/csv_writer.hpp"

namespace steerid {
namespace {

constexpr int kMicroDigits = 6;  // the firmware publishes whole micro-units: more digits would be invented

void write_parameter(CsvWriter& csv, const ParameterEstimate& published) {
  const IdentifiedParameter parameter = from_published(published);
  csv.cell(parameter.value, kMicroDigits).cell(parameter.sd, kMicroDigits).cell(name(parameter.state));
}

}  // namespace

void write_trace(const std::filesystem::path& target, std::span<const Estimate> estimates) {
  CsvWriter csv(target, {"time_s", "inertia_kgm2", "inertia_sd_kgm2", "inertia_state", "damping_nms_per_rad",
                         "damping_sd_nms_per_rad", "damping_state", "stiffness_nm_per_rad", "stiffness_sd_nm_per_rad",
                         "stiffness_state"});
  for (const Estimate& estimate : estimates) {
    csv.cell(static_cast<double>(estimate.stamp_us) * 1e-6, kMicroDigits);
    write_parameter(csv, estimate.inertia);
    write_parameter(csv, estimate.damping);
    write_parameter(csv, estimate.stiffness);
    csv.end_row();
  }
  csv.commit();
}

}  // namespace steerid
