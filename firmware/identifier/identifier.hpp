// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The recursive identifier: J, B and C of the driver's arm on the wheel, one sample at a time.
//
// Model (Lv et al. 2018, equation 1)      T = T_driver - T_motor = J th'' + B th' + C th
// Regression, behind the common filter F  F T = (F th'')J + (F th')B + (F th)C + e,   e white (common_filter.hpp)
//
// Least squares on this is biased, because th'' is made of the measured angle and carries its noise (central
// differences are off by half and more). So the gain is not made of the measured regressor but of an instrument z that
// has no measurement noise in it: the regressor of a free-running wheel 1/(J s^2 + B s + C) on F T, with the
// parameters of now, behind the colour's filter. At the solution z is also the gradient of the output error, and the
// recursion is a recursive Gauss-Newton on it (Soederstroem and Stoica 1983; Young's RSRIVC in the symmetric-gain
// form):
//
//   e = T_f - phi' p;   p := p + P z e / (1 + z' P z);   P := P - P z z' P / (1 + z' P z)      P = U D U'
//
//   settle   0.3 s  the filters fill
//   search   1.5 s  plain least squares, z = phi: biased, but it comes from anywhere
//   refine          the instrument; what was learned from poorer instruments is forgotten within seconds
//
// Forgetting: directional_forgetting.hpp. In the direction that is excited P returns to `memory_floor`, in every other
// direction it stays: nothing winds up on a long curve-hold. What the motion does not show is left alone
// altogether (noise_information.hpp), or the torque sensor's noise would move it. A change detector opens P at once
// when the arm has become another one. Noise: its variance, its colour (noise_colour.hpp, sensor_noise.hpp) and what is
// left of that where motion shows the arm are estimated, so that a standard deviation is one. A residual that is far
// from that variance, or from what the arm known last leaves, says that it is none: nothing is valid then. That arm is
// kept aside meanwhile (known_arm.hpp), and is taken back without a search once it explains what comes in again.
//
// Cost per update, float: see docs/benchmarks.md. No heap, no exception, no libm, no clock. Every update ends
// with D positive and every parameter inside its limits.
#pragma once

#include <cstdint>

#include "identifier/change_detector.hpp"
#include "identifier/common_filter.hpp"
#include "identifier/differentiator.hpp"
#include "identifier/directional_forgetting.hpp"
#include "identifier/free_wheel.hpp"
#include "identifier/known_arm.hpp"
#include "identifier/noise_colour.hpp"
#include "identifier/noise_information.hpp"
#include "identifier/parameter_sum.hpp"
#include "identifier/parameters.hpp"
#include "identifier/residual_noise.hpp"
#include "identifier/search_hand_over.hpp"
#include "identifier/second_order_filter.hpp"
#include "identifier/sensor_noise.hpp"
#include "identifier/ud_covariance.hpp"
#include "identifier/window_information.hpp"

namespace steerid {

/// What is known of one parameter; the port's ParameterState, number for number, without its `fault`, which only
/// the task knows.
enum class Belief : unsigned char { kStarting = 0, kConverging = 1, kValid = 2, kHolding = 3, kNotExcited = 5 };

/// What the identifier is at.
enum class Phase : unsigned char {
  kSettling,          ///< the filters fill
  kSearching,         ///< plain least squares, from the prior
  kSearchingAnother,  ///< the same, for an arm that took the place of the last
  kRefining,          ///< by the instrument; filters, colour and noise are being learned
  kWatching,          ///< all of that is known: parameters may be valid, and another arm is watched for
};

template <class Scalar>
struct IdentifierSettings {
  /// No setting: the lengths of memories, waits and windows are counted in samples at this rate.
  static constexpr Scalar period_s{Scalar(0.01)};
  static constexpr Scalar rate_hz = Scalar(1) / period_s;

  Prior<Scalar> prior;
  /// Relative standard deviation at which a parameter counts as learned.
  Scalar usable{Scalar(0.1)};
  /// Relative standard deviation that forgetting leads back to in directions that are excited: the memory's length.
  Scalar memory_floor{Scalar(0.0003)};
};

/// A steering wheel held by a driver.
template <class Scalar>
inline constexpr IdentifierSettings<Scalar> kSteeringWheel{};

template <class Scalar>
class Identifier {
 public:
  /// `settings` are not copied, so that they can lie in flash: they have to live as long as the identifier does.
  explicit Identifier(const IdentifierSettings<Scalar>& settings = kSteeringWheel<Scalar>)
      : settings_(&settings), p_(Vector3<Scalar>(settings.prior.value)), covariance_(settings.prior.spread) {
    restart();
  }
  explicit Identifier(const IdentifierSettings<Scalar>&& passing) = delete;

  /// Back to the prior, everything forgotten.
  void restart();

  /// After a gap too long to bridge: the filters start again on the next samples, what was learned stays.
  void resettle();

  /// Goes on from what was known at power-off: `value` with one standard deviation of `deviation` each, and the noise
  /// of then. The search is left out and the estimate trusted as little as a search's own, since another driver may
  /// sit there now: the deviations it states are ten times those given. All parameters are `holding` until fresh data
  /// have shown them. The caller keeps to the limits.
  void restore(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation, Scalar noise_nm);

  /// Goes on with an arm that another identifier has found while this one was refining: filters, colour and noise stay.
  void go_on_with(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation);

  /// The measured angle at which the arm pulls with no torque, rad. As if it had always been so: nothing rings.
  void rests_at(Scalar angle_rad) { rest_ = angle_rad; }

  /// Takes in one sample. learn = false lets it through the filters without learning from it (a sample filled in across
  /// a gap). torque_nm = T_driver - T_motor. A sample that is not a number or beyond kLargest is a gap: the filters
  /// start again behind it. The port's integers cannot hold such a thing; other callers may.
  void update(Scalar torque_nm, Scalar angle_rad, bool learn = true);

  [[nodiscard]] Vector3<Scalar> value() const { return p_.value(); }
  [[nodiscard]] Scalar value(int parameter) const { return p_(parameter); }
  /// One standard deviation of each parameter; never more than the prior's, which is what is known without data.
  [[nodiscard]] Vector3<Scalar> standard_deviation() const;
  /// Column i of the covariance that standard_deviation() is the diagonal of, before it is held by the prior.
  [[nodiscard]] Vector3<Scalar> covariance_column(int i) const { return covariance_.column(i) * claimed_variance(); }
  [[nodiscard]] Belief belief(int parameter) const { return belief_[parameter]; }
  /// Standard deviation of the whitened residual, Nm.
  [[nodiscard]] Scalar noise_nm() const { return square_root(noise_.variance()); }
  /// 0 for white noise, towards 1 the more slow unmeasured torque there is.
  [[nodiscard]] Scalar colour_depth() const { return whitening_.depth(); }
  [[nodiscard]] const Prior<Scalar>& prior() const { return settings_->prior; }
  [[nodiscard]] Phase phase() const {
    if (settling_ > 0) return Phase::kSettling;
    if (searching_ > 0) return another_arm_ ? Phase::kSearchingAnother : Phase::kSearching;
    return refined_ < kWatchFrom ? Phase::kRefining : Phase::kWatching;
  }
  /// Whether the last update() took back the arm that was known before a fault (known_arm.hpp).
  [[nodiscard]] bool recovered() const { return recovered_; }
  [[nodiscard]] const SensorNoise<Scalar>& torque_noise() const { return torque_noise_; }
  /// How often the arm was found to be another one.
  [[nodiscard]] unsigned changes() const { return changes_; }
  /// How many times its variance the residual's mean square over the last second may be for a parameter to be valid. Of
  /// noise a second's mean is 1 +- 0.14; a faulty sensor that some wheel nearly explains leaves ten and more.
  static constexpr double kDoubtful = 5;
  /// Nm and rad; ten times what the port accepts, and small enough that no square of a square leaves float's range.
  static constexpr double kLargest = 1000;
  /// The invariant: D positive, parameters inside their limits.
  [[nodiscard]] bool sound() const;
  /// The smallest D of P = U D U', for measurement noise of variance 1: how far the invariant is from its end.
  [[nodiscard]] Scalar least_of_d() const { return covariance_.least(); }

 private:
  // Samples at 100 Hz.
  static constexpr std::uint8_t kSettle = 30;
  static constexpr std::uint8_t kSearch = 150;
  static constexpr std::uint8_t kSearchAgain = 100;
  static constexpr std::uint8_t kColourFrom = 50;  ///< after the start of refining, once the residual is the noise's
  static constexpr std::uint8_t kLearnColourFrom =
      100;  ///< once the parameters do not take up the slow torque any more
  static constexpr std::uint8_t kWatchFrom =
      200;  ///< and once its colour is known: slow torque must not look like another arm
  static constexpr std::int8_t kRefresh = ResidualNoise<Scalar>::kEvery;  ///< between two refreshes
  static constexpr int kEnough = 100;   ///< of a window before it says what is unexcited
  static constexpr double kOpen = 1e6;  ///< covariance of the prior over that of the least noise
  /// No sensor is better than the port's step, and its square by 12 is the variance of its rounding. Less is what a
  /// record without noise leaves: which parameters it shows would be decided between two numbers of no meaning.
  static constexpr double kLeastTorqueNoise = 1e-6 / 12;
  static constexpr double kLeastAngleNoise = 1e-12 / 12;
  /// Samples that the noise behind the whitening filter of before counts for.
  static constexpr std::int16_t kNoiseKept = 20;
  static constexpr double kMostUnmeasured = 0.1;  ///< of the torque's rms
  static constexpr double kRetune = 1.3;          ///< by how much the common filter must be off to be changed
  /// Share of the torque's power that may stay unexplained: an ankle with its reflexes leaves 0.14, a linear drive
  /// with its friction 0.05, and a wheel with a swapped or turned channel half and more.
  static constexpr double kMisfit = 0.15;
  static constexpr double kAstray = 0.04;  ///< the same while nothing is shown, as by a model gone astray
  /// Nm^2: with so little to leave unexplained, the sensors' noise leaves as much.
  static constexpr double kMisfitResidual = 0.0075;
  /// Relative standard deviation of an arm that is taken back: what a fault may have done to it until it was noticed,
  /// 0.4 % rms and seldom more than 2.
  static constexpr double kTakenBack = 0.02;

  // What is not inlined keeps its temporaries off the stack of what runs beside it.
  [[gnu::noinline]] bool take_in(Scalar torque_nm, Scalar angle_rad, bool learn);
  void open_covariance();
  [[gnu::cold, gnu::noinline]] void forget_sensor_noise();
  [[gnu::cold]] void search_anew(std::uint8_t samples);
  [[gnu::cold]] void search(std::uint8_t samples);
  [[gnu::cold]] void start_refining();
  [[gnu::cold, gnu::noinline]] bool took_back(Scalar torque);
  [[gnu::cold, gnu::noinline]] void believe(const Vector3<Scalar>& value, const Vector3<Scalar>& deviation,
                                            Scalar variance);
  [[gnu::cold]] void take_over_what_was_shown();
  [[gnu::cold]] void weigh_anew_what_was_learned_behind(const WhiteningShape<Scalar>& before);
  void forget_what_is_worth_less_than_the_prior();
  [[gnu::always_inline]] void learn_from(Scalar torque, const Vector3<Scalar>& measured,
                                         const Vector3<Scalar>& modelled);
  [[nodiscard]] bool misfits() const;
  [[nodiscard]] bool inside() const;
  [[nodiscard]] Scalar nearest_inside(int parameter) const;
  [[gnu::cold, gnu::noinline]] void bring_inside();
  void learn_noise(Scalar normalised, Scalar square);
  [[gnu::cold, gnu::noinline]] void refresh();
  [[gnu::cold]] void retune(Scalar rho_squared);
  void ring_for(int samples);
  [[nodiscard]] CommonFilter<Scalar> common_filter_now() const {
    return CommonFilter<Scalar>::of(common_, settings_->period_s);
  }
  [[nodiscard, gnu::cold, gnu::noinline]] NoiseInformation<Scalar> pretended_by_the_torque_noise() const;
  [[gnu::cold, gnu::noinline]] void judge_all(const NoiseInformation<Scalar>& pretended);
  [[gnu::cold, gnu::noinline]] void judge(int parameter, Scalar variance, Scalar window_bound, bool credible);
  [[nodiscard, gnu::noinline]] bool doubtful() const;
  /// What a deviation is made of.
  [[nodiscard, gnu::noinline]] Scalar claimed_variance() const {
    return noise_.claimed() * colour_.caution(window_.rate_over_angle());
  }
  /// Mean square of the slow torque that no sensor sees. More than a tenth of the torque's rms is an arm that has
  /// become another one, and has already taught the colour.
  [[nodiscard]] Scalar unmeasured_square() const {
    const Scalar most = Scalar(kMostUnmeasured * kMostUnmeasured) * recent_torque_;
    return colour_.slow_power() < most ? colour_.slow_power() : most;
  }
  [[gnu::cold, gnu::noinline]] void remember();

  const IdentifierSettings<Scalar>* settings_;
  ParameterSum<Scalar> p_;
  UdCovariance<Scalar> covariance_;

  SecondOrderCoefficients<Scalar> common_{};  ///< of the common filter
  SecondOrderFilter<Scalar> torque_filter_, angle_filter_;
  Differentiator<Scalar> measured_, modelled_;
  Scalar torque_late_[Differentiator<Scalar>::kDelay] = {};  ///< behind the whitening filter, the newest first
  FreeWheel<Scalar> model_;
  Scalar rest_{0};  ///< rad

  SensorNoise<Scalar> torque_noise_, angle_noise_;
  NoiseColour<Scalar> colour_;
  WhiteningShape<Scalar> whitening_{};
  WhiteningFilter<Scalar> torque_whitening_, angle_whitening_;
  InverseWhiteningFilter<Scalar> inverse_whitening_;
  WindowInformation<Scalar> window_;
  ChangeDetector<Scalar> change_;

  Scalar noise_at_last_refresh_{0};  ///< its variance of then
  /// Mean squares over the last second, Nm^2.
  Scalar recent_residual_{0}, recent_torque_{0};
  Scalar recent_whitened_{0};  ///< of the torque as the residual has it, behind the whitening filter
  DirectionalForgetting<Scalar> forgetting_;
  [[no_unique_address]] ResidualNoise<Scalar> noise_;
  std::int16_t ringing_ = 0;   ///< samples until a change of the common filter has rung out
  std::uint16_t changes_ = 0;  ///< modulo 65536
  /// The next member lies in its last byte.
  [[no_unique_address]] KnownArm<Scalar> known_;  ///< asked for while it is not the one that is refined
  std::uint8_t settling_ = 0;                     ///< samples until the filters are full
  std::uint8_t searching_ = 0;                    ///< samples of search left
  /// Samples since refining began, from kLearnColourFrom on those that the colour has learned from; stops at
  /// kWatchFrom.
  std::uint8_t refined_ = 0;
  std::int8_t until_refresh_ = 0;
  Held held_ = Held::kNone;
  SearchHandOver<Scalar> hand_over_;
  bool model_waits_ : 1 = false;  ///< until ringing_ is over, where the wheel is
  bool another_arm_ : 1 = false;  ///< the search is for one that took the place of the last
  bool recovered_ : 1 = false;
  Belief belief_[3] = {Belief::kStarting, Belief::kStarting, Belief::kStarting};
};

}  // namespace steerid

#include "identifier/identifier_refresh.hpp"
#include "identifier/identifier_update.hpp"
