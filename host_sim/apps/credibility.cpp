// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/credibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/paint.hpp"
#include "log/bad_input.hpp"

namespace steerid {
namespace {

std::string reason(const Alternative& one) {
  return fmt::format(
      "with {} J would be {:.3g} kg m2, B {:.3g} Nms/rad and C {:.3g} Nm/rad, and the record e^{:.0f} times likelier",
      alternative_words(one), one.value[0], one.value[1], one.value[2], one.evidence_nats);
}

/// Its column probe_nm is a torque that an EPS can be asked for.
constexpr const char* kMakeProbe = "steerid simulate --task drive --probe 1 --out probe.csv";
constexpr const char* kRecordAgain = "record again while the EPS adds a probe, as probe_nm of the next command's file";

/// Where the driver's own torque is not known.
void hold_against_probe(const std::string& log, const Evidence& evidence, Credibility& out) {
  const std::optional<ProbeMisfit>& probe = evidence.probe;
  if (!drives(probe)) {
    out.credible = std::nullopt;
    out.next = kMakeProbe;
    out.reasons.push_back(fmt::format(
        "the driver's own torque is not in the record, so that no run of the model can be held against the angle, and "
        "{}; {}",
        probe                     ? "the probe has driven nothing that stands out of the noise"
        : evidence.probe_recorded ? "the record is too short, or has too many gaps, to show what the probe has driven"
                                  : "no probe has driven the wheel",
        kRecordAgain));
    if (!evidence.anything_valid) return;
    // What is called valid by a probe that drives nothing rests on noise; without one, on a driver who does nothing.
    if (probe)
      out.credible = false;
    else
      out.reasons.emplace_back("what is valid is so only if the driver did next to nothing");
  } else if (probe->nats > 0) {
    out.credible = false;
    out.reasons.push_back(fmt::format(
        "an arm leaves {:.2g} % of the torque that the probe has driven, noise alone {:.2g} %: something else answers "
        "it ({}), as a sensor that is late or slow, dry friction, or a mass beside the arm",
        100 * probe->share, 100 * probe->share_by_noise,
        probe->nats < 1 ? "hardly likelier than not" : fmt::format("e^{:.0f} times likelier", probe->nats)));
    out.next = fmt::format("steerid inspect {}", printable(log));
  } else if (!evidence.anything_valid) {
    out.reasons.push_back(fmt::format(
        "the probe is too weak, or the record too short, to show the arm beside the driver's own torque{}; {}, larger "
        "than this one",
        evidence.record_tells ? " at the record's end, though the whole of it does (--batch)" : "", kRecordAgain));
    out.next = kMakeProbe;
  }
}

}  // namespace

std::string alternative_words(const Alternative& one) {
  switch (one.kind) {
    case Alternative::Kind::kDelay:
      return fmt::format("the angle {:.3g} ms {} than the torque", 1e3 * std::abs(one.size),
                         one.size > 0 ? "later" : "earlier");
    case Alternative::Kind::kClockDrift:
      return fmt::format("clocks that drift apart, by which the angle comes {:.3g} us {} every second,",
                         1e6 * std::abs(one.size), one.size > 0 ? "later" : "earlier");
    case Alternative::Kind::kDryFriction:
      return fmt::format("dry friction of {:.2g} Nm", one.size);
    case Alternative::Kind::kCubicSpring:
      return fmt::format("a spring of {:.2g} Nm/rad3", one.size);
    case Alternative::Kind::kSquareDamping:
      return fmt::format("damping by the square of the rate, {:.2g} Nms2/rad2", one.size);
    case Alternative::Kind::kAsymmetricStiffness:
      return fmt::format("asymmetric stiffness of {:.2g} Nm/rad2", one.size);
  }
  return "";
}

Credibility credibility(const std::string& log, Equation equation, const FirstLook& look, const Evidence& evidence) {
  Credibility out;
  if (!look.doubt.empty()) {
    out.credible = false;
    out.reasons.push_back(look.doubt);
    out.next = fmt::format("steerid inspect {}", printable(log));
    return out;
  }
  const bool known = voluntary_torque_known(equation);
  if (!known) hold_against_probe(log, evidence, out);
  std::vector<std::string> against;
  for (const Alternative& one : evidence.check.alternatives) {
    if (one.matters) against.push_back(reason(one));
  }
  if (!against.empty()) {
    out.credible = false;
    out.next = known ? fmt::format("steerid diagnose --real {} --sim SIM.json --out gap", printable(log))
                     : fmt::format("steerid inspect {}", printable(log));
    out.reasons.insert(out.reasons.begin(), against.begin(), against.end());
  }
  const auto shifting = std::ranges::find_if(evidence.check.alternatives, &Alternative::shifts);
  if (against.empty() && shifting != evidence.check.alternatives.end()) {
    out.reasons.push_back(reason(*shifting) + ": more than the deviations say, which know of noise alone");
  }
  if (!look.misfit.empty()) out.reasons.push_back(look.misfit);
  if (!look.units.steering_wheel()) out.reasons.push_back(no_wheel_words(look.units));
  return out;
}

std::string credibility_lines(const Credibility& credibility) {
  std::string text;
  const bool refused = credibility.credible == false;
  for (const std::string& reason : credibility.reasons) {
    text += refused ? painted(Paint::kRed, "not credible: ") : painted(Paint::kAmber, "with caution: ");
    text += reason + "\n";
  }
  if (!credibility.next.empty()) text += fmt::format("next: {}\n", credibility.next);
  return text;
}

}  // namespace steerid
