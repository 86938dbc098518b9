// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The page of a diagnosis: its sentences and which parts stand on it, for every kind of verdict.
#include "apps/diagnosis_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/diagnosis_words.hpp"
#include "apps/possibilities.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

gap::Diagnosis friction() {
  gap::Diagnosis d;
  d.verdict = "coulomb_friction";
  for (const std::string& id : gap::verdict_ids()) d.ranking.push_back({id, id == d.verdict ? 0.9 : 0.1 / 24});
  std::swap(d.ranking[0],
            *std::find_if(d.ranking.begin(), d.ranking.end(), [](auto& r) { return r.probability > 0.5; }));
  Effect effect(find_effect("coulomb_friction"));
  effect.values[0] = 0.482;
  d.causes.push_back({effect, {{0.482, 0.47, 0.49}}, 0.97, gap::ChangeKind::kAdd, 0.9});
  d.gap.sim_nrmse = 0.25;
  d.gap.refit_nrmse = 0.1;
  d.gap.with_effect_nrmse = 0.0123;
  d.gap.floor_nrmse = 0.01;
  d.gap.closed_fraction = {0.974, 0.94, 0.99};
  d.where.says = "Most of the gap lies around rate zero.";
  d.axes = {{"velocity", "rad/s", {{-1, 0, {0.7, 0.6, 0.8}, 0.5}, {0, 1, {0.3, 0.2, 0.4}, 0.5}}, {}, 0.4},
            {"time", "s", {{0, 10, {1, 1, 1}, 1}}, {}, 0.0}};
  d.map = {{0, 1, 2}, {-1, 0, 1}, {0.1, -0.2, 0.3, std::nan("")}, {0, 0, 0.01, std::nan("")}};
  for (int i = 0; i < 2000; ++i) {
    d.series.time_s.push_back(0.01 * i);
    d.series.measured_rad.push_back(std::sin(0.01 * i));
    // The simulation is far off in the held-out part only between 12 and 14 s, and elsewhere before 5 s.
    d.series.sim_rad.push_back(std::sin(0.01 * i) + (i < 500 ? 1.0 : i >= 1200 && i < 1400 ? 0.5 : 0.0));
    d.series.refit_rad.push_back(std::sin(0.01 * i));
    d.series.with_effect_rad.push_back(std::sin(0.01 * i));
    d.series.held_out.push_back(i >= 1000 ? 1 : 0);
  }
  return d;
}

template <class T>
std::vector<T> parts_of(const report::Page& page) {
  std::vector<T> out;
  for (const report::Part& part : page.parts) {
    if (const T* found = std::get_if<T>(&part)) out.push_back(*found);
  }
  return out;
}

report::Page page_of(const gap::Diagnosis& d) { return diagnosis_page({"drive.csv", "sim.json", d, {}}); }

TEST(DiagnosisWords, SayWhatExplainsTheGapAndHowMuchOfIt) {
  EXPECT_EQ(
      verdict_sentence(friction()),
      "Coulomb friction (friction 0.482 Nm) explains the gap and closes 97 % of it (94 to 99 %). The free run misses "
      "the measured angle by 25.0 % as given, by 10.0 % with the best J, B and C alone, and by 1.23 % with the "
      "effect.");
}

TEST(DiagnosisWords, ClaimAPartOfTheGapWhereMostOfItRemains) {
  gap::Diagnosis d = friction();
  d.gap.closed_fraction = {0.23, -0.42, 0.44};
  EXPECT_NE(verdict_sentence(d).find("explains a part of the gap and closes 23 % of it"), std::string::npos)
      << verdict_sentence(d);
  d.gap.closed_fraction = {0.51, 0.4, 0.6};
  EXPECT_NE(verdict_sentence(d).find("explains the gap and closes 51 % of it"), std::string::npos)
      << verdict_sentence(d);
}

TEST(DiagnosisWords, NameWhatCannotBeToldApart) {
  gap::Diagnosis d = friction();
  d.equivalent = {"stribeck_friction", "lag", "delay"};
  EXPECT_TRUE(verdict_sentence(d).ends_with("This record cannot tell it from Stribeck friction, lag or delay."));
}

TEST(DiagnosisWords, SayWhereTheFreeRunDoesNotCloseTheGap) {
  gap::Diagnosis d = friction();
  d.gap.closed_fraction = {-0.4, -0.9, -0.1};
  d.gap.with_effect_nrmse = 0.136;
  EXPECT_EQ(
      verdict_sentence(d),
      "Coulomb friction (friction 0.482 Nm) explains what the record shows, but a free run with it does not close "
      "the gap. The free run misses the measured angle by 25.0 % as given, by 10.0 % with the best J, B and C "
      "alone, and by 13.6 % with the effect.");
  d.verdict = "unknown";
  d.surrogate = true;
  d.causes[0].probability = 0.28;
  EXPECT_TRUE(verdict_sentence(d).ends_with("The nearest surrogate is Coulomb friction (probability 0.28)."));
}

TEST(DiagnosisWords, DoNotCallASurrogateTheCause) {
  gap::Diagnosis d = friction();
  d.verdict = "unknown";
  d.surrogate = true;
  d.causes[0].probability = 0.04;
  // More than half of the probability is on changes of the library, none of which is likely.
  EXPECT_NE(verdict_sentence(d).find("a gap and no change is sure enough to be named:"), std::string::npos);
  std::ranges::find(d.ranking, "unknown", &gap::RankedEffect::id)->probability = 0.9;
  EXPECT_NE(verdict_sentence(d).find("a gap that no effect of the library explains:"), std::string::npos);
  EXPECT_NE(verdict_sentence(d).find("is Coulomb friction (probability 0.04); it closes 97 % of it (94 to 99 %)."),
            std::string::npos);
  // A surrogate that leaves no more than noise does is no cause either, but it explains the record.
  d.gap.with_effect_nrmse = 0.9 * d.gap.floor_nrmse;
  EXPECT_NE(verdict_sentence(d).find("a gap and no change is sure enough to be named:"), std::string::npos);
  d.causes.clear();
  EXPECT_TRUE(verdict_sentence(d).ends_with(
      "It has no surrogate: no effect is shown to bring the free run nearer than J, B and C alone."));
}

TEST(DiagnosisWords, SayOfARunAtTheNoiseThatOnlyItsSpectrumIsNone) {
  gap::Diagnosis d = friction();
  d.verdict = "unknown";
  d.causes.clear();
  std::ranges::find(d.ranking, "unknown", &gap::RankedEffect::id)->probability = 0.9;
  d.gap.refit_nrmse = 0.9 * d.gap.floor_nrmse;
  EXPECT_EQ(verdict_sentence(d).find("There is a gap"), std::string::npos);
  EXPECT_NE(verdict_sentence(d).find("no more than noise alone would"), std::string::npos) << verdict_sentence(d);
  d.gap.refit_nrmse = 1.1 * d.gap.floor_nrmse;
  EXPECT_NE(verdict_sentence(d).find("There is a gap"), std::string::npos);
}

TEST(DiagnosisWords, DoNotRepeatAnEndOfAnInterval) {
  EXPECT_EQ(percent_range(0.94, 0.99), "94 to 99 %");
  EXPECT_EQ(percent_range(0.998, 1.002), "to half a per cent");
  EXPECT_EQ(percent_range(0.5, std::nan("")), "interval unknown");
}

TEST(DiagnosisWords, SayWhatASurrogateNeedsOfJBAndC) {
  gap::Diagnosis d = friction();
  d.verdict = "unknown";
  d.surrogate = true;
  d.base_out_of_place = true;
  d.base = {{0.11, 0.1, 0.12}, {1.5, 1.4, 1.6}, {22, 21, 23}};
  EXPECT_TRUE(verdict_sentence(d).ends_with(
      "; it closes 97 % of it (94 to 99 %). It needs J 0.110 kg m\u00b2, B 1.50 Nms/rad, C 22.0 Nm/rad, which is too "
      "far from the simulation's: if they are right, give them to the simulation and diagnose again."))
      << verdict_sentence(d);
}

TEST(DiagnosisWords, SayNothingOfClosingAGapThatTheFreeRunDoesNotShow) {
  gap::Diagnosis d = friction();
  d.verdict = "unknown";
  d.gap.closed_fraction = {std::nan(""), -1500, -3};
  EXPECT_EQ(verdict_sentence(d).find("closes"), std::string::npos) << verdict_sentence(d);
  EXPECT_NE(verdict_sentence(d).find("the spectrum of what is missing"), std::string::npos);
  const auto closed = std::get<report::Headline>(page_of(d).parts.at(0)).numbers.at(1);
  EXPECT_EQ(closed.value, "\u2013");
  EXPECT_EQ(closed.note.find('%'), std::string::npos) << closed.note;
}

TEST(DiagnosisWords, NoneAndParameters) {
  gap::Diagnosis d = friction();
  d.causes.clear();
  d.verdict = "none";
  d.gap.sim_nrmse = d.gap.with_effect_nrmse = 0.0104;
  d.unexplained.complete = true;
  EXPECT_EQ(
      verdict_sentence(d),
      "The simulation explains this record down to its noise: the free run misses by 1.04 %, the noise alone leaves "
      "1.00 %.");
  d.verdict = "parameters";
  d.gap.sim_nrmse = 0.25;
  d.base = {{0.11, 0.1, 0.12}, {1.5, 1.4, 1.6}, {22, 21, 23}};
  EXPECT_EQ(verdict_sentence(d),
            "The model is right, its numbers are not: with J 0.110 kg m\u00b2, B 1.50 Nms/rad, C 22.0 Nm/rad the free "
            "run's error falls from 25.0 % to 1.04 %, down to the noise.");
  d.unexplained.complete = false;
  EXPECT_EQ(
      verdict_sentence(d),
      "The model needs other numbers: with J 0.110 kg m\u00b2, B 1.50 Nms/rad, C 22.0 Nm/rad the free run's error "
      "falls from 25.0 % to 1.04 %, where the noise alone would leave 1.00 %.");
  d.gap.sim_nrmse = 0.0100;
  EXPECT_EQ(verdict_sentence(d),
            "The record says J 0.110 kg m\u00b2, B 1.50 Nms/rad, C 22.0 Nm/rad, other than the simulation, but no free "
            "run shows it: the held-out part is missed by 1.04 % with these numbers and by 1.00 % as given, where the "
            "noise alone would leave 1.00 %.");
}

TEST(DiagnosisWords, NothingIsDownToTheNoiseThatIsNot) {
  gap::Diagnosis d = friction();
  d.causes.clear();
  d.unexplained.complete = false;
  d.verdict = "none";
  EXPECT_EQ(verdict_sentence(d),
            "The record shows nothing that the simulation lacks, but its free run misses the measured angle by 25.0 %, "
            "where the noise alone would leave 1.00 %.");
  d.verdict = "parameters";
  d.gap.with_effect_nrmse = 0.1;
  EXPECT_TRUE(verdict_sentence(d).ends_with("falls from 25.0 % to 10.0 %, where the noise alone would leave 1.00 %."))
      << verdict_sentence(d);
}

TEST(DiagnosisWords, UnitsComeFromTheNames) {
  EXPECT_EQ(in_unit(0.5, "friction_nm"), "0.500 Nm");
  EXPECT_EQ(in_unit(2, "breakaway_ratio"), "2.00");
  EXPECT_EQ(quantity_of("breakaway_ratio"), "breakaway ratio");
  EXPECT_EQ(quantity_of("grip_damping_nms_per_rad"), "grip damping");
  EXPECT_EQ(unit_of("quadratic_damping_nms2_per_rad2"), "Nm s\u00b2/rad\u00b2");
  EXPECT_EQ(unit_of("stribeck_rate_rad_s"), "rad/s");
  EXPECT_EQ(unit_of("cubic_stiffness_nm_per_rad3"), "Nm/rad\u00b3");
  EXPECT_EQ(unit_of("delay_s"), "s");
}

TEST(DiagnosisWords, EveryParameterOfTheVocabularyHasAUnitOrIsANumber) {
  for (const EffectType* type : effects()) {
    for (const Parameter& parameter : type->parameters) {
      const std::string_view name = parameter.name;
      const bool number = name == "sharpness" || name.ends_with("shape") || name.ends_with("share") ||
                          name.ends_with("ratio") || name.ends_with("exponent") || name.ends_with("probability");
      EXPECT_EQ(unit_of(name).empty(), number) << name;
    }
  }
}

TEST(DiagnosisPage, GivesNoFiguresOfARunThatOnlyALoopWouldHold) {
  gap::Diagnosis d = friction();
  d.only_the_loop_holds = true;
  d.gap.closed_fraction.value = std::nan("");
  d.gap.with_effect_nrmse = 2.7e7;
  EXPECT_EQ(
      verdict_sentence(d),
      "Coulomb friction (friction 0.482 Nm) explains what the record shows. Only the loop holds the wheel with it, "
      "so that no free run can say how far the gap closes: as given it misses the measured angle by 25.0 %.");
  const report::Page page = page_of(d);
  const auto& headline = std::get<report::Headline>(page.parts.at(0));
  EXPECT_EQ(headline.numbers.at(1).note, "only the loop holds the wheel");
  EXPECT_EQ(headline.numbers.at(3).value, "\u2013");
  EXPECT_EQ(headline.numbers.at(3).unit, "");
}

/// Friction and a lag that are both sure: the ranking gives each a half.
gap::Diagnosis friction_and_lag() {
  gap::Diagnosis d = friction();
  for (gap::RankedEffect& one : d.ranking) one.probability = one.id == "lag" || one.id == d.verdict ? 0.49 : 0.001;
  d.causes[0].closes = 0.75;
  d.causes[0].probability = 0.99;
  Effect lag(find_effect("lag"));
  d.causes.push_back({lag, {{0.01, 0.009, 0.011}}, 0.224, gap::ChangeKind::kResize, 0.96, {}, lag});
  d.inclusion = {{&effect::coulomb_friction, gap::ChangeKind::kAdd, 0.99, {}},
                 {&effect::lag, gap::ChangeKind::kResize, 0.96, {}},
                 {&effect::lag, gap::ChangeKind::kRemove, 0.03, {}},
                 {&effect::delay, gap::ChangeKind::kAdd, 0.02, {}}};
  d.unexplained = {.share_of_gap = 0.026, .complete = false, .where = gap::Unexplained::Band{0, 0.5, 0.7}};
  return d;
}

TEST(Possibilities, GiveEachOfSeveralChangesItsOwnProbability) {
  const std::vector<Possibility> all = possibilities(friction_and_lag());
  ASSERT_GE(all.size(), 4U);
  EXPECT_EQ(all[0].name, "Coulomb friction");
  EXPECT_DOUBLE_EQ(all[0].probability, 0.99);
  EXPECT_EQ(all[1].name, "lag of another size");
  EXPECT_TRUE(all[0].named && all[1].named);
  EXPECT_EQ(all[2].name, "no lag");
  EXPECT_EQ(all[3].name, "delay");
  EXPECT_FALSE(all[2].named || all[3].named);
  EXPECT_DOUBLE_EQ(probability_of_answer(friction_and_lag()), 0.96);
}

TEST(DiagnosisWords, NameAllOfASurrogateThatClosesTogether) {
  gap::Diagnosis d = friction_and_lag();
  d.verdict = "unknown";
  d.surrogate = true;
  d.causes[0].probability = 0.3;
  d.causes[1].probability = 0.25;
  EXPECT_NE(
      verdict_sentence(d).find("The nearest surrogate is Coulomb friction (probability 0.30) and lag (probability "
                               "0.25); it closes 97 % of it"),
      std::string::npos)
      << verdict_sentence(d);
}

TEST(Possibilities, TakeWhatNoChangeIsFromTheRanking) {
  gap::Diagnosis d = friction_and_lag();
  d.verdict = "unknown";
  d.causes.clear();
  d.inclusion.clear();
  for (gap::RankedEffect& one : d.ranking) one.probability = one.id == "unknown" ? 0.9 : 0.1 / 24;
  EXPECT_DOUBLE_EQ(probability_of_answer(d), 0.9);
  EXPECT_EQ(possibilities(d).size(), d.ranking.size());
}

TEST(DiagnosisPage, ShowsWhatEachOfSeveralChangesClosesAndWhatIsLeft) {
  const gap::Diagnosis d = friction_and_lag();
  const report::Page page = page_of(d);
  const auto& headline = std::get<report::Headline>(page.parts.at(0));
  EXPECT_EQ(headline.numbers.at(0).value, "2 changes");
  EXPECT_EQ(headline.numbers.at(0).note, "probability 0.96 or more, each");
  EXPECT_NE(headline.verdict.find("Of the gap 3 % is left, most of it below 0.5 Hz."), std::string::npos)
      << headline.verdict;
  const std::vector<report::Bars> bars = parts_of<report::Bars>(page);
  const auto budget = std::ranges::find(bars, "The budget of the gap", &report::Bars::title);
  ASSERT_NE(budget, bars.end());
  EXPECT_EQ(budget->categories, (std::vector<std::string>{"Coulomb friction", "lag", "what is left"}));
  double sum = 0;
  for (const double share : budget->series.at(0).values) sum += share;
  EXPECT_NEAR(sum, 100, 1e-9);
}

TEST(DiagnosisPage, BeginsWithTheVerdictAndShowsTheWorstUnseenStretch) {
  const report::Page page = page_of(friction());
  ASSERT_TRUE(std::holds_alternative<report::Headline>(page.parts.at(0)));
  const auto& headline = std::get<report::Headline>(page.parts.at(0));
  EXPECT_EQ(headline.tone, report::Tone::kGood);
  EXPECT_EQ(headline.numbers.at(1).value, "97");
  EXPECT_EQ(headline.numbers.at(1).note, "94 to 99 %");
  const auto& closer = std::get<report::LineChart>(page.parts.at(1));
  ASSERT_EQ(closer.series.size(), 3U);
  EXPECT_EQ(closer.series[2].name, "with Coulomb friction");
  EXPECT_LE(closer.series[0].x.front(), 12.0);
  EXPECT_GE(closer.series[0].x.back(), 13.99);
  EXPECT_GE(closer.series[0].x.front(), 5.0);  // the larger errors before 5 s are not of the unseen part
}

// A simulation that drifts away would make a flat line of all the rest.
TEST(DiagnosisPage, KeepsTheMotionInSightWhereASimulationDriftsAway) {
  gap::Diagnosis d = friction();
  for (std::size_t i = 500; i < d.series.sim_rad.size(); ++i) d.series.sim_rad[i] = static_cast<double>(i);
  const std::vector<report::LineChart> charts = parts_of<report::LineChart>(page_of(d));
  for (const std::string_view title : {"Measured and simulated", "Measured less simulated"}) {
    const auto chart = std::ranges::find(charts, title, &report::LineChart::title);
    ASSERT_NE(chart, charts.end());
    ASSERT_TRUE(chart->y.range) << title;
    EXPECT_LT(chart->y.range->at(1), 5) << title;
    EXPECT_NE(chart->caption.find("A simulation leaves the picture"), std::string::npos) << chart->caption;
  }
  for (const report::LineChart& chart : parts_of<report::LineChart>(page_of(friction()))) EXPECT_FALSE(chart.y.range);
}

// No axis shows the seconds since 1970 so that two samples could be told apart.
TEST(DiagnosisPage, CountsDatesFromTheRecordsBeginning) {
  constexpr double kDate_s = 1.7e9;
  gap::Diagnosis dated = friction();
  for (double& stamp : dated.series.time_s) stamp += kDate_s;
  for (gap::GapAxis& axis : dated.axes) {
    if (axis.axis != "time") continue;
    for (gap::GapBin& bin : axis.bins) bin.low += kDate_s, bin.high += kDate_s;
  }
  const auto last = [](const gap::Diagnosis& d) {
    return parts_of<report::LineChart>(page_of(d)).at(0).series.at(0).x.back();
  };
  EXPECT_NEAR(last(dated), last(friction()), 1e-6);
}

TEST(DiagnosisPage, AsksForNoProbeWhereNoneIsProposed) {
  const auto about_a_probe = [](const gap::Diagnosis& d) {
    int found = 0;
    for (const report::Note& note : parts_of<report::Note>(page_of(d))) {
      for (const std::string& text : note.paragraphs) found += text.find("multisine") != std::string::npos ? 1 : 0;
    }
    return found;
  };
  gap::Diagnosis d = friction();
  d.next_experiment.why = "No other effect of the library is left that a probe could tell apart.";
  EXPECT_EQ(about_a_probe(d), 0);
  d.next_experiment.separates = {"coulomb_friction", "backlash"};
  d.next_experiment.probe = {.rms_nm = 2.6, .low_hz = 0.2, .high_hz = 5, .period_s = 10, .duration_s = 60};
  EXPECT_EQ(about_a_probe(d), 1);
}

TEST(DiagnosisPage, ShowsTheFastestRatesOnTop) {
  const auto maps = parts_of<report::Heatmap>(page_of(friction()));
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].rows.front(), "0.5");
  EXPECT_DOUBLE_EQ(maps[0].values.at(0).at(0), 0.3);
  EXPECT_DOUBLE_EQ(maps[0].values.at(1).at(1), -0.2);
  EXPECT_EQ(maps[0].value.range, maps[1].value.range);
}

TEST(DiagnosisPage, IsCautiousAboutWhatIsNotCertain) {
  gap::Diagnosis d = friction();
  d.equivalent = {"delay"};
  EXPECT_EQ(std::get<report::Headline>(page_of(d).parts.at(0)).tone, report::Tone::kCaution);
  d.verdict = "unknown";
  EXPECT_EQ(std::get<report::Headline>(page_of(d).parts.at(0)).tone, report::Tone::kBad);
}

TEST(DiagnosisPage, HoldsEveryVerdictWithoutFigures) {
  for (const char* verdict : {"none", "parameters", "unknown", "coulomb_friction"}) {
    gap::Diagnosis d;
    d.verdict = verdict;
    for (const std::string& id : gap::verdict_ids()) d.ranking.push_back({id, 1.0 / 25});
    const std::string html = report::html(page_of(d));
    EXPECT_NE(html.find("Diagnosis of drive.csv"), std::string::npos) << verdict;
  }
}

}  // namespace
}  // namespace steerid
