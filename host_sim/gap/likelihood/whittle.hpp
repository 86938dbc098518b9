// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The likelihood of a record under a model, on the Fourier lines of its blocks (Whittle 1953):
//
//   -log L = sum over lines of log S_k + |r_k|^2 / S_k
//
// r is measured minus predicted angle, S the noise floor's density (gap/likelihood/noise_floor.hpp), with the model's
// own |H|^2 in it; in log S what is left of a torque's noise where there was nothing else passes one wheel's |H|^2 for
// all models (NoiseFloor::counted_density), or whatever passes less of it would gain. Each block's ends are projected
// out (gap/likelihood/block_spectra.hpp). A fit is Gauss-Newton on r/sqrt(S) with S held, then S anew from the
// parameters found, until that changes nothing; the size of the slow torque is fitted with it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "gap/likelihood/block_spectra.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/likelihood/prior.hpp"

namespace steerid::gap {

/// Strong evidence: odds of 20 to 1 (Kass and Raftery, Journal of the American Statistical Association 90, 1995).
inline constexpr double kStrong_nats = 3.0;

/// From a torque to the recorded angle, one value a line.
struct Response {
  Spectrum gain;        ///< H, with the channel
  Spectrum ends;        ///< H without its zeros: what the state at a block's ends passes through
  Spectrum late{};      ///< by what delay the recorded torque acts on the recorded angle; empty: at once
  Spectrum on_wheel{};  ///< H without the channel; empty: the channel changes nothing

  /// From the recorded torque.
  [[nodiscard]] Spectrum gain_of_recorded() const { return late.size() > 0 ? gain.cwiseProduct(late) : gain; }
  /// From a torque that was worked out on the recorded motion, and has passed the channel with it.
  [[nodiscard]] const Spectrum& gain_on_motion() const { return on_wheel.size() > 0 ? on_wheel : gain; }
};

/// What a model says about the record at parameters x: residual = measured - predicted, and the response that shapes
/// noise and block ends.
class ResidualModel {
 public:
  virtual ~ResidualModel() = default;
  virtual void evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) = 0;
  /// The residual at each of some points.
  [[nodiscard]] virtual std::vector<Spectrum> residuals_at(std::span<const Eigen::VectorXd> points);
};

/// Limits, step and prior of a fitted number.
struct Fitted {
  double low = 0;
  double high = 0;
  double scale = 1;  ///< first step of a fit; differences are taken over a thousandth of it
  Prior prior{};
};

/// How what a model leaves moves with its numbers at x: one spectrum a number, by how much the residual moves when that
/// moves by one. Zero for a number that is a choice (Fitted::scale of 0).
using Slopes = std::function<std::vector<Spectrum>(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted)>;

/// A model's own, by differences to `here`, its residual at x: as many evaluations as numbers.
[[nodiscard]] std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x, const Spectrum& here,
                                                const std::vector<Fitted>& fitted);
/// One evaluation more.
[[nodiscard]] std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x,
                                                const std::vector<Fitted>& fitted);

/// x with every number within its limits.
[[nodiscard]] Eigen::VectorXd within(Eigen::VectorXd x, const std::vector<Fitted>& fitted);

/// How large the slow unmeasured torque may be, as a share of the applied torque's rms.
enum class SlowTorque {
  kFloor,  ///< up to some 2 %: part of the floor
  kCause,  ///< from 5 % on
};

/// What a slow torque of that share of the applied one costs, nats, beside what it gains.
[[nodiscard]] double slow_penalty(double share, SlowTorque slow);

/// Sums over the lines of the blocks of one role.
struct Misfit {
  double cost = 0;   ///< sum log S + |r|^2/S: minus log likelihood
  double chi = 0;    ///< sum |r|^2/S
  double lines = 0;  ///< degrees of freedom / 2: complex lines less the ends projected out
  [[nodiscard]] double excess() const { return lines > 0 ? chi / lines : 0; }  ///< 1 at the floor
  Misfit& operator+=(const Misfit& other) {
    cost += other.cost;
    chi += other.chi;
    lines += other.lines;
    return *this;
  }
};

class Whittle {
 public:
  /// `white` holds the white levels; `applied_rms_nm` is the rms of the applied torque.
  Whittle(const BlockSpectra& spectra, NoiseFloor white, double applied_rms_nm)
      : spectra_(spectra), white_(white), applied_rms_nm_(applied_rms_nm) {}

  using Roles = std::vector<Block::Role>;

  struct Fit {
    Eigen::VectorXd x{};
    NoiseFloor floor{};
    Eigen::MatrixXd information{};   ///< of x, from the lines used and the priors
    double penalty = 0;              ///< of the priors, on x and on the slow torque
    double shift = 0;                ///< of that, for numbers that are not of the size that was given
    std::array<Misfit, 3> misfit{};  ///< by role
    Spectrum residual{};             ///< at x
    Response response{};             ///< at x

    /// Minus log likelihood on the blocks of `roles`, penalties included.
    [[nodiscard]] double cost(const Roles& roles) const { return penalty + over(roles).cost; }
    [[nodiscard]] double excess(const Roles& roles) const { return over(roles).excess(); }
    [[nodiscard]] Misfit over(const Roles& roles) const {
      Misfit sum;
      for (const Block::Role role : roles) sum += misfit[static_cast<std::size_t>(role)];
      return sum;
    }
  };

  /// `budget` limits the evaluations of the model. `slopes`, where given, stand in for the model's
  /// own, which take an evaluation a number; where a step along them gains nothing, the model's own are taken. With
  /// them no fit ends further from the record than it begins: steps with S held may pass the likeliest point by.
  [[nodiscard]] Fit fit(ResidualModel& model, const Eigen::VectorXd& start, const std::vector<Fitted>& fitted,
                        const Roles& roles, SlowTorque slow, int budget, const Slopes& slopes = nullptr) const;

  /// What the lines and the priors tell of a fit's numbers, whose slopes there are these.
  [[nodiscard]] Eigen::MatrixXd information(const Fit& fit, const std::vector<Spectrum>& slopes,
                                            const std::vector<Fitted>& fitted, const Roles& roles) const;

  /// Everything of a Fit but x and the information.
  [[nodiscard]] Fit judge(ResidualModel& model, const Eigen::VectorXd& x, const std::vector<Fitted>& fitted,
                          const Roles& roles, SlowTorque slow) const;

  /// The residual over sqrt(S), the blocks' ends projected out; real and imaginary parts of the blocks of `roles`, and
  /// one number a shape of the hidden torque.
  class Whitened {
   public:
    /// Keeps a reference to the spectra.
    Whitened(const BlockSpectra& spectra, const Response& response, const NoiseFloor& floor, const Roles& roles);
    [[nodiscard]] Eigen::VectorXd operator()(const Spectrum& signal) const;
    /// The signal without its blocks' ends, not whitened; zero in the blocks of other roles.
    [[nodiscard]] Spectrum without_ends(const Spectrum& signal) const;
    /// The part of every line up to `highest_rad_s`, one a bin, that the hidden torque leaves known.
    [[nodiscard]] Eigen::VectorXd known(const BlockSpectra& spectra, double highest_rad_s) const;
    /// What a residual is worth, by role; nothing for other roles.
    [[nodiscard]] std::array<Misfit, 3> misfits(const Spectrum& residual) const;
    [[nodiscard]] Eigen::Index rows() const { return rows_; }
    [[nodiscard]] double sum_log_density() const;
    [[nodiscard]] double lines() const;

   private:
    struct Part {
      const BlockSpectra::Bins* bins = nullptr;
      Eigen::MatrixXd ends;    // orthonormal
      Eigen::MatrixXd trends;  // orthonormal, and orthogonal to the ends
      Eigen::VectorXd shrink;  // one a trend: what is taken off along it
      Eigen::MatrixXd hidden;  // what the hidden torque may add, one shape a column
      Eigen::MatrixXd root;    // lower triangle; its square is 1 + hidden' hidden
      double sum_log_density = 0;
      double lines = 0;
      [[nodiscard]] Eigen::Index rows() const { return 2 * bins->count + hidden.cols(); }
    };
    /// `variance` and `rate_variance`: mean squares of the slow torque and of all torque's derivative.
    void add_trends(const BlockSpectra& spectra, const Response& response, double variance, double rate_variance,
                    Part& part) const;
    void add_hidden(const Response& response, Part& part) const;
    /// Ends and trends taken off.
    static void clean(const Part& part, Eigen::Ref<Eigen::MatrixXd> rows);

    std::vector<Part> parts_;
    Eigen::VectorXd weight_;  // one a bin of these
    Eigen::Index rows_ = 0;
  };

  /// Sets the size and colour of the floor's slow torque, by what a model leaves, and returns its penalty.
  double fit_slow(const Spectrum& residual, const Response& response, const Roles& roles, SlowTorque slow,
                  NoiseFloor& floor) const;

  [[nodiscard]] const BlockSpectra& spectra() const { return spectra_; }
  [[nodiscard]] const NoiseFloor& white() const { return white_; }
  [[nodiscard]] double applied_rms_nm() const { return applied_rms_nm_; }

 private:
  /// The rest of a fit whose x, residual and response are known.
  [[nodiscard]] Fit judged(Fit fit, const std::vector<Fitted>& fitted, const Roles& roles, SlowTorque slow) const;

  const BlockSpectra& spectra_;
  NoiseFloor white_;
  double applied_rms_nm_;
};

/// Whether blocks of the role are among those of `roles`.
[[nodiscard]] inline bool is_among(const Whittle::Roles& roles, Block::Role role) {
  return std::ranges::find(roles, role) != roles.end();
}

/// All that is not held out.
inline const Whittle::Roles kFitted = {Block::Role::kFit};
inline const Whittle::Roles kSeen = {Block::Role::kFit, Block::Role::kChoose};
inline const Whittle::Roles kAllRoles = {Block::Role::kFit, Block::Role::kChoose, Block::Role::kReport};

/// The step of a difference to a fitted number: away from its upper limit.
[[nodiscard]] inline double difference_step(const Fitted& one, double at) {
  const double step = 1e-3 * one.scale;
  return at + step > one.high ? -step : step;
}

}  // namespace steerid::gap
