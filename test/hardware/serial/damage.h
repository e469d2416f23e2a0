#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <utility>

namespace microinjection {

/// What a bad line makes of a device's replies: they are cut off, garbled, have foreign bytes in them, come twice, or
/// late, behind or before the next one.
class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::mt19937& random() { return random_; }
  bool holds() const { return !held_.empty(); }  ///< a reply that comes late
  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_); }

  /// What arrives of `reply`. @pre it is not empty
  std::string operator()(const std::string& reply) {
    if (!held_.empty()) {
      const std::string late = std::exchange(held_, "");
      return below(2) ? late + reply : reply + late;
    }
    const std::size_t at = below(reply.size());
    std::string arrives = reply;
    switch (below(9)) {
      case 0:  // cut off
        return arrives.substr(0, at);
      case 1:  // its begin is missing
        return arrives.substr(at + 1);
      case 2:
        return arrives.erase(at, 1);
      case 3:
        return arrives.insert(at, 1, byte());
      case 4:  // one bit
        arrives[at] = static_cast<char>(arrives[at] ^ (1 << below(8)));
        return arrives;
      case 5:  // noise of the same length
        for (char& each : arrives) each = byte();
        return arrives;
      case 6:  // noise before or behind
        for (std::size_t i = 0, more = 1 + below(40); i < more; ++i) {
          arrives.insert(below(2) ? arrives.size() : 0, 1, byte());
        }
        return arrives;
      case 7:
        return arrives + arrives;
      default:
        held_ = reply;
        return "";
    }
  }

 private:
  char byte() { return static_cast<char>(below(256)); }

  std::mt19937 random_;
  std::string held_;  ///< comes with the next reply
};

}  // namespace microinjection
