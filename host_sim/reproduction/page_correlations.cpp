// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Figure 10 of the paper, and the test that it lacks.
#include "reproduction/conclusions.hpp"
#include "reproduction/page_parts.hpp"

namespace steerid::page {
namespace {

std::string p_text(double p) { return p < 1e-4 ? "<\u00a00.0001" : fmt::format("{:.4f}", p); }

report::Table effect_table(const ExperimentResults& results) {
  report::Table out;
  out.title = "Which labels work: analysis of variance with repeated measures";
  out.caption = fmt::format(
      "Subjects as a random effect, hand positions as categories. \u03b5: Greenhouse and Geisser's correction of the "
      "degrees of freedom. Of the subjects all of whose records have a valid answer. p adjusted by Holm's method for "
      "the twelve tests; a label works where it is below {}. Partial \u03b7\u00b2: the label's share of what is "
      "neither subject nor another label. r beside it: Pearson's, of all records as if they were independent, with the "
      "positions counted 1, 2, 3, as in the paper.",
      kSignificance);
  out.columns = {words("label and quantity"),
                 words("subjects"),
                 numbers("F", "", 4),
                 words("degrees of freedom"),
                 numbers("\u03b5", "", 3),
                 words("p, Holm"),
                 numbers("partial \u03b7\u00b2", "", 2),
                 numbers("r", "", 2)};
  for (const LabelCorrelation& one : results.correlations) {
    const RepeatedMeasures& effect = one.effect;
    const bool tested = effect.tested();
    out.rows.push_back({fmt::format("{} \u2192 {}", kLabels[one.label], kQuantities[one.quantity]),
                        fmt::format("{}", effect.subjects), tested ? effect.f : kNothing,
                        tested ? fmt::format("{}, {}", effect.between(), effect.within()) : std::string("\u2013"),
                        tested ? effect.epsilon : kNothing,
                        tested ? p_text(one.effect_holm_p) : std::string("not tested"),
                        tested ? effect.partial_eta_squared : kNothing, one.plain.coefficient});
  }
  return out;
}

}  // namespace

void add_correlations(report::Page& page, const ExperimentResults& results) {
  page.parts.push_back(report::Section{
      "Figure 10: labels and parameters",
      "A subject is measured twelve times: records are not independent, and a hand position is a name, no number. What "
      "a label does is therefore tested within the subjects."});
  page.parts.push_back(effect_table(results));
  report::Note note{.title = "Beside what the paper says"};
  for (const LabelCorrelation& one : results.correlations) note.paragraphs.push_back(on_label(one));
  page.parts.push_back(note);
  report::Heatmap map{.title = "The paper's figure: Pearson's r between labels and parameters",
                      .caption =
                          "Labels counted as: passive 1, active 0; one or two hands; 3 or 3 + 9 o'clock 1, 12 or 12 + "
                          "6 2, 1:30 or 10:10 3.",
                      .x_label = "parameter",
                      .y_label = "label"};
  for (const std::string_view quantity : kQuantities) map.columns.emplace_back(quantity);
  for (std::size_t label = 0; label < kLabels.size(); ++label) {
    map.rows.emplace_back(kLabels[label]);
    map.values.emplace_back();
  }
  for (const LabelCorrelation& one : results.correlations) map.values[one.label].push_back(one.plain.coefficient);
  map.value = {.label = "r", .range = std::array{-1.0, 1.0}};
  map.diverging = true;
  map.digits = 2;
  page.parts.push_back(map);
}

}  // namespace steerid::page
