// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/sensor_channel.hpp"

#include <algorithm>

namespace steerid::sensor {
namespace {
constexpr double kTickS = static_cast<double>(kTickPeriodUs) * 1e-6;
}  // namespace

Channel::Channel(const ChannelDefects& defects, std::uint64_t seed, std::uint64_t stream)
    : defects_(defects),
      dropout_(defects.dropout),
      noise_random_(seed, 2 * stream),
      dropout_random_(seed, 2 * stream + 1) {
  if (defects.lag.time_constant_s > 0.0) tick_decay_ = defects.lag.decay(kTickS);
}

void Channel::extend(const Cubic& signal) {
  Piece next{signal, signal.c0};
  if (defects_.lag.time_constant_s > 0.0 && extended_ > 0) {
    const Piece& last = pieces_[static_cast<std::size_t>(extended_ - 1) % kPieces];
    next.lagged_at_start = defects_.lag.respond(last.lagged_at_start, last.signal, kTickS, tick_decay_);
  }
  pieces_[static_cast<std::size_t>(extended_) % kPieces] = next;
  ++extended_;
}

bool Channel::lagging(std::int64_t instant_us) const {
  return defects_.lag.time_constant_s > 0.0 && defects_.lag.during.covers(instant_us);
}

double Channel::analogue(std::int64_t instant_us) const {
  // Before the start the signal stood at its first value, which is in memory for as long as it can be asked for.
  const std::int64_t source_us = std::max<std::int64_t>(0, defects_.delay.source_us(instant_us));
  const std::int64_t piece_number = source_us / kTickPeriodUs;
  const Piece& piece = pieces_[static_cast<std::size_t>(piece_number) % kPieces];
  const double tau_s = static_cast<double>(source_us - piece_number * kTickPeriodUs) * 1e-6;
  if (!lagging(instant_us)) return piece.signal.at(tau_s);
  const double decay = tau_s == 0.0 ? 1.0 : defects_.lag.decay(tau_s);
  return defects_.lag.respond(piece.lagged_at_start, piece.signal, tau_s, decay);
}

Channel::Reading Channel::convert(double x, std::int64_t instant_us) {
  double y = defects_.gain.apply(x, instant_us);
  y = defects_.bias.apply(y, instant_us);
  y = defects_.noise.apply(y, instant_us, noise_random_);
  y = defects_.saturation.apply(y, instant_us);
  y = defects_.resolution.apply(y, instant_us);

  const bool lost = dropout_.lost(instant_us, dropout_random_);
  if (!lost || !started_) last_good_ = y;
  const bool stuck = defects_.stuck.during.covers(instant_us) && started_;
  if (!stuck) delivered_ = last_good_;
  started_ = true;
  return {delivered_, !(lost && defects_.dropout.flagged)};
}

}  // namespace steerid::sensor
