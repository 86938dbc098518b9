// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/plotjuggler_layout.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "apps/identification_trace.hpp"
#include "log/table_writer.hpp"
#include "log/whole_file.hpp"
#include "report/escaped.hpp"

namespace steerid {
namespace {

struct Plot {
  std::string_view title;
  std::array<std::string_view, 3> curves;  ///< value, low, high
};

constexpr std::array kPlots = {
    Plot{"J in kg m2", {"inertia_kgm2", "inertia_low_kgm2", "inertia_high_kgm2"}},
    Plot{"B in Nms/rad", {"damping_nms_per_rad", "damping_low_nms_per_rad", "damping_high_nms_per_rad"}},
    Plot{"C in Nm/rad", {"stiffness_nm_per_rad", "stiffness_low_nm_per_rad", "stiffness_high_nm_per_rad"}},
};
// Value, and both ends of its interval in one colour.
constexpr std::array<std::string_view, 3> kColours = {"#1f77b4", "#aec7e8", "#aec7e8"};

std::string plots(std::string_view prefix) {
  std::string text;
  for (const Plot& plot : kPlots) {
    text += fmt::format("     <DockArea name=\"{}\">\n      <plot mode=\"TimeSeries\" style=\"Lines\">\n", plot.title);
    for (std::size_t i = 0; i < plot.curves.size(); ++i) {
      text += fmt::format("       <curve name=\"{}{}\" color=\"{}\"/>\n", prefix, plot.curves.at(i), kColours.at(i));
    }
    text += "      </plot>\n     </DockArea>\n";
  }
  return text;
}

}  // namespace

void write_layout(const std::filesystem::path& target, const std::filesystem::path& trace) {
  const bool mcap = is_mcap_name(trace);
  const std::string prefix = mcap ? fmt::format("/steerid/{}/", kTraceTable) : std::string();
  const auto folder = std::filesystem::absolute(target).lexically_normal().parent_path();
  const auto whole = std::filesystem::absolute(trace).lexically_normal();
  const auto name = whole.parent_path() == folder ? whole.filename() : whole;
  const std::string_view loader = mcap ? "DataLoad MCAP" : "DataLoad CSV";
  const std::string_view settings = mcap ? "" : R"(<default time_axis="time_s" delimiter="0"/>)";
  write_whole_file(target,
                   fmt::format(R"(<?xml version='1.0' encoding='UTF-8'?>
<root>
 <tabbed_widget name="Main Window" parent="main_window">
  <Tab tab_name="estimate with 95 % intervals" containers="1">
   <Container>
    <DockSplitter orientation="-" count="3" sizes="0.34;0.33;0.33">
{}    </DockSplitter>
   </Container>
  </Tab>
  <currentTabIndex index="0"/>
 </tabbed_widget>
 <use_relative_time_offset enabled="0"/>
 <Plugins>
  <plugin ID="{}">{}</plugin>
 </Plugins>
 <previouslyLoaded_Datafiles>
  <fileInfo filename="{}" prefix="">
   <plugin ID="{}">{}</plugin>
  </fileInfo>
 </previouslyLoaded_Datafiles>
</root>
)",
                               plots(prefix), loader, settings, report::escaped(name.string()), loader, settings));
}

}  // namespace steerid
