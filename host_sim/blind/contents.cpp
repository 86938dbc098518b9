// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "blind/contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "blind/catalogue.hpp"
#include "blind/draw.hpp"

namespace steerid::blind {
namespace {

enum Stream : std::uint64_t { kDeck = 1, kRemainder = 10 };

template <class T>
void shuffle(std::vector<T>& deck, Draw& draw) {
  for (std::size_t i = deck.size(); i > 1; --i) std::swap(deck[i - 1], deck[draw.index(i)]);
}

/// In their order: what a sensor adds it adds to whatever it measures, a hand that is away too.
std::array<std::span<const Kind>, 4> families() {
  return {friction_kinds(), joint_kinds(), torque_kinds(), record_kinds()};
}

/// An offset b of the torque beside dry friction of F+ and F-, sliding or stuck, is dry friction of F+ + b and F- - b,
/// which is one effect while b is the smaller.
bool is_one_effect(const Contents& contents) {
  const auto has = [&](std::string_view id) {
    return std::ranges::any_of(contents, [&](const Content& one) { return one.id == id; });
  };
  return has("torque_bias") && (has("coulomb_friction") || has("asymmetric_friction"));
}

/// What is known of a wheel before a drive: neither what happens at an instant nor what a record suffers.
bool is_of_the_wheel(std::string_view id) {
  constexpr std::array<std::string_view, 9> kOfOneDrive = {
      "hands_off",         "time_varying_stiffness", "periodic_disturbance", "unmeasured_torque", "torque_drift",
      "torque_saturation", "coarse_quantization",    "sample_loss",          "torque_bias"};
  return std::ranges::find(kOfOneDrive, id) == kOfOneDrive.end();
}

/// One effect of each of as many families as there are roles; false where a simulation cannot have what it should.
bool try_to_fill(const std::vector<Simulated>& roles, Draw& draw, Contents& out) {
  std::vector<std::size_t> of = {0, 1, 2, 3};
  shuffle(of, draw);
  std::vector<std::pair<std::size_t, Content>> drawn;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const auto kinds = families()[of[i]];
    const std::string id(kinds[draw.index(kinds.size())].id);
    if (roles[i] != Simulated::kNot && !is_of_the_wheel(id)) return false;
    drawn.emplace_back(of[i], Content(id, roles[i]));
  }
  std::ranges::sort(drawn, {}, &std::pair<std::size_t, Content>::first);
  out.clear();
  for (auto& [family, content] : drawn) out.push_back(std::move(content));
  return !is_one_effect(out);
}

}  // namespace

std::vector<Contents> draw_contents(std::size_t count, std::uint64_t seed) {
  Draw draw(seed, kDeck);
  std::vector<Contents> all;
  while (all.size() < count) {
    std::vector<Contents> deck(4, {"none"});
    deck.insert(deck.end(), 4, {"parameters"});
    for (const Kind* kind : vocabulary()) deck.insert(deck.end(), 2, {std::string(kind->id)});
    for (const Kind* kind : outside()) deck.push_back({std::string(kind->id)});
    shuffle(deck, draw);
    all.insert(all.end(), deck.begin(), deck.end());
  }
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  return all;
}

std::vector<Contents> draw_pairs(std::size_t count, std::uint64_t seed) {
  Draw draw(seed, kDeck);
  std::vector<Contents> all;
  while (all.size() < count) {
    const std::size_t drawn = draw.index(families().size());
    const std::size_t beside = (drawn + 1 + draw.index(families().size() - 1)) % families().size();
    const auto one = families()[std::min(drawn, beside)];
    const auto other = families()[std::max(drawn, beside)];
    Contents pair = {std::string(one[draw.index(one.size())].id), std::string(other[draw.index(other.size())].id)};
    if (!is_one_effect(pair)) all.push_back(std::move(pair));
  }
  return all;
}

std::vector<Contents> draw_several(std::size_t count, std::uint64_t seed) {
  using enum Simulated;
  using Roles = std::vector<Simulated>;
  Draw draw(seed, kDeck);
  std::vector<Contents> all;
  while (all.size() < count) {
    std::vector<Roles> deck = {{kAsItIs},
                               {kAsItIs},
                               {kAsItIs, kAsItIs},
                               {kResized},
                               {kResized},
                               {kAsItIs, kResized},
                               {kAlone},
                               {kAsItIs, kAlone},
                               {kNot, kAsItIs},
                               {kNot, kAsItIs},
                               {kNot, kAsItIs},
                               {kNot, kAsItIs, kAsItIs},
                               {kNot, kResized},
                               {kNot, kNot, kAsItIs},
                               {kNot, kNot, kAsItIs},
                               {kNot, kNot, kNot, kAsItIs},
                               {kNot, kNot},
                               {kNot, kNot, kNot},
                               {kNot, kNot, kNot},
                               {kNot, kNot, kNot, kNot}};
    shuffle(deck, draw);
    for (const Roles& roles : deck) {
      Contents contents;
      while (!try_to_fill(roles, draw, contents)) {
      }
      all.push_back(std::move(contents));
    }
  }
  all.erase(all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
  return all;
}

std::vector<Contents> with_remainders(std::vector<Contents> all, std::uint64_t seed) {
  Draw draw(seed, kRemainder);
  const auto changes = [](const Content& one) { return is_known(one.id) && one.simulated != Simulated::kAsItIs; };
  for (Contents& contents : all) {
    if (!std::ranges::any_of(contents, changes)) continue;
    contents.emplace_back(std::string(outside()[draw.index(outside().size())]->id));
  }
  return all;
}

std::string several_case(const Contents& contents) {
  const bool remains = std::ranges::any_of(contents, [](const Content& one) { return is_known(one.id); });
  const auto count = [&](Simulated how) {
    return std::ranges::count_if(
        contents, [&](const Content& one) { return one.simulated == how && (is_known(one.id) || !remains); });
  };
  const auto missing = count(Simulated::kNot);
  const auto kept = count(Simulated::kAsItIs);
  const auto resized = count(Simulated::kResized);
  const auto superfluous = count(Simulated::kAlone);
  if (missing + resized + superfluous == 0) return "exact";
  if (missing == 0 && superfluous == 0) return "resized";
  if (missing == 0 && resized == 0) return "superfluous";
  if (resized + superfluous > 0) return "mixed";
  return kept > 0 ? fmt::format("{} missing beside {}", missing, kept) : fmt::format("{} missing", missing);
}

}  // namespace steerid::blind
