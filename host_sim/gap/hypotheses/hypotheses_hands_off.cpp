// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The hand leaves: found in time first. The residual torque of the linear wheel is large in short windows; their comb
// of equal distances is what the search looks for.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "gap/hypotheses/hypotheses.hpp"
#include "plant/effects/hands_away.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/free_run.hpp"

namespace steerid::gap {
namespace {

/// Steps in which the hand's leaving and its return are looked for; what is shorter is no hands_off.
constexpr double kStep_s = 0.1;

/// Where a search begins: a period beyond any record, and the wheel's shares of J and B.
double once_s() { return effect::hands_off.parameters[0].prior.mean; }
double inertia_share() { return effect::hands_off.parameters[3].preset; }
double damping_share() { return effect::hands_off.parameters[4].preset; }

/// The shortest period that is looked for.
constexpr double kShortestPeriod_s = 4;

/// How fast a hand fades where a search begins.
constexpr double kFade_s = 0.05;

/// Mean square of the residual torque in bins of `bin_s`.
std::vector<double> residual_power(const WheelArm& wheel, const Record& record, const MeasuredMotion& motion,
                                   double bin_s) {
  const auto bins = static_cast<std::size_t>(motion.time_s.back() / bin_s) + 1;
  std::vector<double> power(bins, 0.0);
  std::vector<double> count(bins, 0.0);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double rest = record.net_torque_nm(i) - wheel.inertia_kgm2 * motion.acceleration_rad_s2[i] -
                        wheel.damping_nms_per_rad * motion.rate_rad_s[i] -
                        wheel.stiffness_nm_per_rad * motion.angle_rad[i];
    const auto bin = static_cast<std::size_t>(motion.time_s[i] / bin_s);
    power[bin] += rest * rest;
    count[bin] += 1;
  }
  for (std::size_t b = 0; b < bins; ++b) power[b] = count[b] > 0 ? power[b] / count[b] : 0;
  return power;
}

class HandsOff final : public Hypothesis {
 public:
  HandsOff()
      : Hypothesis(effect::hands_off, {.momentary = true,
                                       .lets_go = true,
                                       .timed = true,
                                       .knows = {.inertia = true, .damping = true, .stiffness = true}}) {}
  /// Who lets go and reaches again takes a quarter of a second and more; what is shorter stands in for samples that are
  /// off, and a hand that takes all of the inertia with it for whatever is off at single moments. What a loop moves
  /// while the hand is away says little of the inertia that is left. A hand that is back before the record begins is
  /// another state to begin from, and one that is away as long as the record is another J, B and C.
  [[nodiscard]] bool beyond_usual(const double* values, const Usual& usual) const override {
    const double record_s = usual.record.length_s();
    const double away_s = record_s * away(values).mean_share(usual.record.middle_s(), record_s);
    return std::min(values[1], away_s) >= kStep_s && record_s - away_s > FreeRun::Options{}.stretch_s &&
           (usual.loop_holds || keeps_inertia(values[3], type().parameters[3]));
  }
  void torque(const WheelArm& wheel, const double* values, const Record& /*record*/, const MeasuredMotion& motion,
              std::vector<double>& torque_nm) const override {
    const effect::HandsAway hands = away(values);
    for (std::size_t i = 0; i < torque_nm.size(); ++i) {
      const double share = hands.mean_share(motion.time_s[i], kSoftEdge_s);
      torque_nm[i] = share * ((1 - values[3]) * wheel.inertia_kgm2 * motion.acceleration_rad_s2[i] +
                              (1 - values[4]) * wheel.damping_nms_per_rad * motion.rate_rad_s[i] +
                              wheel.stiffness_nm_per_rad * motion.angle_rad[i]);
    }
  }

  [[nodiscard]] Starts starts(const WheelArm& wheel, const Record& record,
                              const MeasuredMotion& motion) const override {
    const std::vector<double> power = residual_power(wheel, record, motion, kStep_s);
    Starts starts{.keep = 3};
    std::vector<std::size_t> order(power.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return power[a] > power[b]; });
    // The strongest bins, one a second, are where the hand may have left.
    std::vector<std::size_t> peaks;
    for (const std::size_t bin : order) {
      const bool apart = std::ranges::none_of(
          peaks, [&](std::size_t other) { return std::max(bin, other) - std::min(bin, other) < 15; });
      if (apart) peaks.push_back(bin);
      if (peaks.size() == 10) break;
    }
    for (const double away : {0.2, 0.4, 1.0}) add_combs(peaks, power, kStep_s, away, motion.time_s.front(), starts);
    const WheelArm alone{inertia_share() * wheel.inertia_kgm2, damping_share() * wheel.damping_nms_per_rad, 0};
    add_absence(power, residual_power(alone, record, motion, kStep_s), starts);
    return starts;
  }
  /// Twice and three times as often, or half as often: a period of which every second absence is one of the hand's is a
  /// local optimum.
  [[nodiscard]] std::vector<std::vector<double>> missed(const std::vector<double>& found) const override {
    std::vector<std::vector<double>> all;
    if (found[0] >= once_s()) return all;
    const auto leave = [&](double period_s, double first_s) {
      if (period_s < kShortestPeriod_s) return;
      all.push_back(found);
      all.back()[0] = period_s;
      all.back()[2] = first_s;
    };
    leave(found[0] / 2, found[2]);
    leave(found[0] / 3, found[2]);
    leave(2 * found[0], found[2]);
    leave(2 * found[0], found[2] + found[0]);
    return all;
  }

 private:
  [[nodiscard]] effect::HandsAway away(const double* values) const {
    return effect::HandsAway({values, static_cast<std::size_t>(std::ssize(type().parameters))});
  }

  /// One absence of seconds: the window in which the wheel alone explains the torque better than arm and wheel, by the
  /// most in all.
  static void add_absence(const std::vector<double>& held, const std::vector<double>& alone, Starts& starts) {
    double gained = 0, best = 0;
    std::size_t since = 0, first = 0, last = 0;
    for (std::size_t bin = 0; bin < held.size(); ++bin) {
      if (gained <= 0) {
        gained = 0;
        since = bin;
      }
      gained += held[bin] - alone[bin];
      if (gained > best) {
        best = gained;
        first = since;
        last = bin + 1;
      }
    }
    if (!(best > 0)) return;
    const double first_s = kStep_s * static_cast<double>(first);
    const double away_s = kStep_s * static_cast<double>(last - first);
    for (const double fade_s : {kFade_s / 4, kFade_s}) {
      starts.values.push_back({once_s(), away_s, first_s - fade_s, inertia_share(), damping_share(), fade_s});
    }
  }

  /// The three combs with the highest mean power at their teeth; a comb of one tooth has a period beyond the record.
  static void add_combs(const std::vector<std::size_t>& peaks, const std::vector<double>& power, double bin_s,
                        double away, double begin_s, Starts& starts) {
    struct Comb {
      double score, period, first;
    };
    std::vector<Comb> combs;
    // What the strongest of five bins reaches where nothing happens, several times over.
    std::vector<double> sorted;  // of the bins that hold samples
    std::ranges::copy_if(power, std::back_inserter(sorted), [](double one) { return one > 0; });
    if (sorted.empty()) return;
    std::ranges::sort(sorted);
    const double background = 8 * sorted[sorted.size() * 8 / 10];
    const auto score = [&](double first, double period) {
      double sum = 0;
      for (double at = first - std::floor(first / period) * period; at < static_cast<double>(power.size()) * bin_s;
           at += period) {
        const auto bin = static_cast<std::size_t>(at / bin_s);
        double tooth = 0;
        for (std::size_t k = bin > 0 ? bin - 1 : 0; k < std::min(power.size(), bin + 4); ++k) {
          tooth = std::max(tooth, power[k]);
        }
        // A missing tooth costs what a tooth gains; one in a gap nothing.
        if (tooth > 0) sum += std::log(tooth / background);
      }
      return sum;
    };
    for (std::size_t a = 0; a < peaks.size(); ++a) {
      const double first = static_cast<double>(peaks[a]) * bin_s;
      for (std::size_t b = a + 1; b < peaks.size(); ++b) {
        const double distance = std::abs(static_cast<double>(peaks[b]) - static_cast<double>(peaks[a])) * bin_s;
        for (const int parts : {1, 2, 3, 4, 5}) {
          const double period = distance / parts;
          if (period > kShortestPeriod_s) combs.push_back({score(first, period), period, first});
        }
      }
      if (a == 0) combs.push_back({score(first, once_s()), once_s(), first});
    }
    std::ranges::sort(combs, [](const Comb& x, const Comb& y) { return x.score > y.score; });
    const auto [same, last] = std::ranges::unique(combs, [&](const Comb& x, const Comb& y) {
      const double apart = (y.first - x.first) / x.period;
      return std::abs(x.period - y.period) < bin_s / 2 && std::abs(apart - std::round(apart)) * x.period < bin_s / 2;
    });
    combs.erase(same, last);
    if (combs.size() > 4) combs.resize(4);
    for (const Comb& comb : combs) {
      for (const double before : {away / 2, 0.05}) {
        const double first = comb.first + bin_s / 2 - before;
        const double turns = std::floor((first - begin_s) / comb.period);
        for (const double fade_s : {kFade_s / 4, kFade_s}) {
          starts.values.push_back(
              {comb.period, away, first - turns * comb.period, inertia_share(), damping_share(), fade_s});
        }
      }
    }
  }
};

}  // namespace

void add_hands_off_hypothesis(Hypotheses& all) { add<HandsOff>(all); }

}  // namespace steerid::gap
