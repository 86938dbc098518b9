// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/correlations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace steerid {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Association correlation(std::span<const double> x, std::span<const double> y, double freedom) {
  if (x.size() < 3 || freedom < 1) return {};
  const double x0 = mean(x);
  const double y0 = mean(y);
  double xx = 0;
  double yy = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - x0) * (x[i] - x0);
    yy += (y[i] - y0) * (y[i] - y0);
    xy += (x[i] - x0) * (y[i] - y0);
  }
  if (!(xx > 0) || !(yy > 0)) return {};
  const double r = xy / std::sqrt(xx * yy);
  return {r, incomplete_beta(1 - r * r, freedom / 2, 0.5)};
}

/// Values less the mean of their class; classes from 0.
std::vector<double> without_means(std::span<const double> values, std::span<const std::size_t> label) {
  const std::size_t classes = 1 + *std::max_element(label.begin(), label.end());
  std::vector<double> sum(classes);
  std::vector<double> count(classes);
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum[label[i]] += values[i];
    count[label[i]] += 1;
  }
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i] - sum[label[i]] / count[label[i]];
  return out;
}

std::size_t distinct(std::span<const std::size_t> label) {
  std::vector<std::size_t> sorted(label.begin(), label.end());
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

std::vector<std::size_t> ascending(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  return order;
}

std::size_t label_of(std::size_t label, const RecordingSettings& what) {
  switch (label) {
    case 0:
      return what.task == TaskKind::kPassive ? 1 : 0;
    case 1:
      return both_arms(what.hands) ? 2 : 1;
    default:
      return 1 + static_cast<std::size_t>(what.hands) % 3;
  }
}

/// A number for what a record shares with those that differ from it in `label` only.
std::size_t group_of(std::size_t label, const IdentifiedRecord& record) {
  std::size_t group = record.subject;
  for (std::size_t other = 0; other < kLabels.size(); ++other) {
    group = 4 * group + (other == label ? 0 : label_of(other, record.what));
  }
  return group;
}

/// The quantity of one record, when its answer may say it.
std::optional<double> quantity_of(std::size_t quantity, const ArmAnswer& answer) {
  if (quantity < 3) {
    if (!answer.valid(static_cast<int>(quantity))) return std::nullopt;
    return answer.value[quantity];
  }
  const std::optional<NaturalFrequency> frequency = answer.frequency();
  if (!frequency || frequency->defined != NaturalFrequency::Defined::kYes) return std::nullopt;
  return frequency->hz;
}

/// The mean of each subject at each class of the label. Subjects of whom one record has no answer are left out: means
/// over different records are not alike.
std::vector<std::vector<double>> subjects_by_class(std::span<const IdentifiedRecord> records, std::size_t label,
                                                   std::size_t quantity) {
  std::map<std::size_t, std::map<std::size_t, std::vector<double>>> values;
  std::set<std::size_t> incomplete;
  for (const IdentifiedRecord& record : records) {
    const std::optional<double> value = quantity_of(quantity, record.batch);
    if (!value) incomplete.insert(record.subject);
    values[record.subject][label_of(label, record.what)].push_back(value.value_or(0));
  }
  std::vector<std::vector<double>> table;
  for (const auto& [subject, classes] : values) {
    if (incomplete.contains(subject)) continue;
    table.emplace_back();
    for (const auto& [name, here] : classes) table.back().push_back(mean(here));
  }
  return table;
}

LabelCorrelation correlate(std::span<const IdentifiedRecord> records, std::size_t label, std::size_t quantity) {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<std::size_t> classes;
  std::vector<std::size_t> group;
  for (const IdentifiedRecord& record : records) {
    const std::optional<double> value = quantity_of(quantity, record.batch);
    if (!value) continue;
    classes.push_back(label_of(label, record.what));
    x.push_back(static_cast<double>(classes.back()));
    y.push_back(*value);
    group.push_back(group_of(label, record));
  }
  LabelCorrelation out{
      .label = label, .quantity = quantity, .records = y.size(), .plain = {}, .paired = {}, .ratio = {}, .effect = {}};
  out.effect = repeated_measures(subjects_by_class(records, label, quantity));
  if (y.empty()) return out;
  out.plain = pearson(x, y);
  out.paired = pearson_paired(x, y, group);
  out.ratio = correlation_ratio(classes, y);
  return out;
}

}  // namespace

Association pearson(std::span<const double> x, std::span<const double> y) {
  return correlation(x, y, static_cast<double>(x.size()) - 2);
}

Association pearson_paired(std::span<const double> x, std::span<const double> y, std::span<const std::size_t> group) {
  if (x.empty()) return {};
  const double freedom = static_cast<double>(x.size()) - static_cast<double>(distinct(group)) - 1;
  return correlation(without_means(x, group), without_means(y, group), freedom);
}

Association correlation_ratio(std::span<const std::size_t> label, std::span<const double> y) {
  const std::size_t classes = label.empty() ? 0 : distinct(label);
  if (classes < 2 || y.size() <= classes) return {};
  double total = 0;
  double inside = 0;
  const double y0 = mean(y);
  const std::vector<double> left = without_means(y, label);
  for (std::size_t i = 0; i < y.size(); ++i) {
    total += (y[i] - y0) * (y[i] - y0);
    inside += left[i] * left[i];
  }
  if (!(total > 0)) return {};
  const double between = static_cast<double>(classes) - 1;
  const double within = static_cast<double>(y.size() - classes);
  return {1 - inside / total, incomplete_beta(inside / total, within / 2, between / 2)};
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<double> out(p.size());
  double largest = 0;
  const std::vector<std::size_t> order = ascending(p);
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(p.size() - i) * p[order[i]]));
    out[order[i]] = largest;
  }
  return out;
}

std::vector<double> benjamini_hochberg(std::span<const double> p) {
  std::vector<double> out(p.size());
  double smallest = 1;
  const std::vector<std::size_t> order = ascending(p);
  for (std::size_t i = order.size(); i-- > 0;) {
    smallest = std::min(smallest, static_cast<double>(p.size()) / static_cast<double>(i + 1) * p[order[i]]);
    out[order[i]] = smallest;
  }
  return out;
}

std::vector<LabelCorrelation> label_correlations(std::span<const IdentifiedRecord> records) {
  std::vector<LabelCorrelation> all;
  for (std::size_t label = 0; label < kLabels.size(); ++label) {
    for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
      all.push_back(correlate(records, label, quantity));
    }
  }
  const auto adjusted = [&](auto p_of, auto method) {
    std::vector<double> p;
    for (const LabelCorrelation& one : all) p.push_back(p_of(one));
    return method(p);
  };
  const auto plain = adjusted([](const auto& one) { return one.plain.p; }, holm);
  const auto share = adjusted([](const auto& one) { return one.plain.p; }, benjamini_hochberg);
  const auto paired = adjusted([](const auto& one) { return one.paired.p; }, holm);
  const auto ratio = adjusted([](const auto& one) { return one.ratio.p; }, holm);
  const auto effect = adjusted([](const auto& one) { return one.effect.p; }, holm);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].holm_p = plain[i];
    all[i].benjamini_hochberg_p = share[i];
    all[i].paired_holm_p = paired[i];
    all[i].ratio_holm_p = ratio[i];
    all[i].effect_holm_p = effect[i];
  }
  return all;
}

}  // namespace steerid
