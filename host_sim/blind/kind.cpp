#include "blind/kind.hpp"

#include <algorithm>
#include <stdexcept>

namespace steerid::blind {

double& Numbers::at(std::string_view name) {
  for (auto& [key, value] : all_) {
    if (key == name) return value;
  }
  throw std::logic_error("there is no number " + std::string(name));
}

double Numbers::operator[](std::string_view name) const { return const_cast<Numbers*>(this)->at(name); }

Numbers scaled(const Kind& kind, const Numbers& numbers, double factor) {
  Numbers out = numbers;
  for (const Size& size : kind.sizes) {
    double& value = out.at(size.name);
    const double distance = value - size.origin;
    const double wanted = size.origin + (size.weaker_when_larger ? distance / factor : distance * factor);
    // Both signs of a distance from the origin are physical; the limits are of its magnitude.
    const double magnitude = std::clamp(std::abs(wanted - size.origin), size.low, size.high);
    value = size.origin + (distance < 0 ? -magnitude : magnitude);
  }
  return out;
}

}  // namespace steerid::blind
