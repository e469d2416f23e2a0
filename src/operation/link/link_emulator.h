#pragma once

#include <queue>
#include <random>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

struct LinkConditions {
  double delay = 0;   ///< s, smallest delay in one direction
  double jitter = 0;  ///< s, added delay: uniform in [0, jitter], so packets overtake each other
  double loss = 0;    ///< 1, share of packets that never arrive
  unsigned seed = 1;

  static LinkConditions read(ConfigReader reader);
};

/// One direction of a network in virtual time: delays, reorders and loses packets. The same seed
/// loses the same packets.
template <typename Packet>
class LinkEmulator {
 public:
  explicit LinkEmulator(const LinkConditions& conditions) : conditions_(conditions), random_(conditions.seed) {}

  /// Sends a packet at `now` (s).
  void send(const Packet& packet, double now) {
    // Both random numbers are drawn for each packet, so that the delays do not depend on the loss.
    const double extra_delay = uniform_(random_) * conditions_.jitter;
    if (uniform_(random_) < conditions_.loss) return;
    travelling_.push({now + conditions_.delay + extra_delay, sent_++, packet});
  }

  /// Returns the packets that arrived by `now` (s), in the order of arrival.
  std::vector<Packet> receive(double now) {
    std::vector<Packet> arrived;
    for (; !travelling_.empty() && travelling_.top().arrival <= now; travelling_.pop()) {
      arrived.push_back(travelling_.top().packet);
    }
    return arrived;
  }

 private:
  struct Travelling {
    double arrival;  ///< s
    long order;
    Packet packet;
    bool operator<(const Travelling& other) const {
      return arrival != other.arrival ? arrival > other.arrival : order > other.order;
    }
  };

  LinkConditions conditions_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::priority_queue<Travelling> travelling_;
  long sent_ = 0;
};

}  // namespace microinjection
