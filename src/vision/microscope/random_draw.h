#pragma once

#include <cstdint>
#include <random>

namespace microinjection {

/// An interval to draw from, both ends included.
struct DrawInterval {
  double low, high;
};

/// Random numbers. Unlike the standard distributions, it gives the same values with every standard library.
class RandomDraw {
 public:
  explicit RandomDraw(std::uint64_t seed) : random_(seed) {}
  double within(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }
  double within(const DrawInterval& interval) { return within(interval.low, interval.high); }
  bool chance(double probability) { return within(0, 1) < probability; }
  int upTo(int most) { return static_cast<int>(within(0, most + 1.0)); }
  std::uint64_t bits() { return random_(); }

 private:
  std::mt19937_64 random_;
};

}  // namespace microinjection
