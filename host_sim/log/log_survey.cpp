// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_survey.hpp"

#include <algorithm>
#include <cmath>

#include "log/quantile.hpp"
#include "log/record_quality.hpp"

namespace steerid {
namespace {

ColumnSurvey survey_of(const std::vector<double>& time_s, const std::vector<double>& values) {
  ColumnSurvey survey{.whole_numbers = true};
  std::vector<double> steps;
  double last_s = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    if (std::isnan(value)) continue;
    if (survey.values > 0 && time_s[i] > last_s) steps.push_back(time_s[i] - last_s);
    last_s = time_s[i];
    survey.low = survey.values == 0 ? value : std::min(survey.low, value);
    survey.high = survey.values == 0 ? value : std::max(survey.high, value);
    survey.whole_numbers = survey.whole_numbers && value == std::round(value);
    ++survey.values;
  }
  survey.whole_numbers = survey.whole_numbers && survey.values > 0;
  if (steps.empty()) return survey;
  const double middle_s = median(steps);
  survey.rate_hz = 1.0 / middle_s;
  survey.gaps = static_cast<std::size_t>(
      std::ranges::count_if(steps, [&](double step_s) { return step_s > longest_interval_s(middle_s); }));
  return survey;
}

}  // namespace

std::vector<ColumnSurvey> survey_columns(LogSource& source, const std::optional<WantedColumn>& time) {
  Wanted wanted{.time = time, .text_is_missing = true};
  for (std::size_t column = 0; column < source.columns().size(); ++column) {
    if (!time || time->column != column) wanted.columns.push_back({.column = column});
  }
  std::vector<ColumnSurvey> surveys(wanted.columns.size());
  for (const StampedColumns& group : source.read(wanted)) {
    for (std::size_t i = 0; i < group.wanted.size(); ++i) {
      surveys[group.wanted[i]] = survey_of(group.time_s, group.values[i]);
    }
  }
  for (std::size_t i = 0; i < surveys.size(); ++i) surveys[i].column = wanted.columns[i].column;
  return surveys;
}

}  // namespace steerid
