#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "virtual_session.h"

namespace microinjection {

/// The force along the needle (N) of the served cell and of the cell that is under the needle, at the same pose.
struct ForcePair {
  double felt = 0, truth = 0;
  double error() const { return felt / truth - 1; }
};

/// Of a session with a hidden cell.
class FeltForces {
 public:
  explicit FeltForces(VirtualSession& session)
      : felt_(session.world().hear<geometry_msgs::WrenchStamped>("/cell/predicted_cf")),
        true_(session.world().hear<geometry_msgs::WrenchStamped>("/true_cell/predicted_cf")) {}

  void clear() {
    felt_.clear();
    true_.clear();
  }
  /// In the order of time. Both forces have the stamp of the needle's pose that they are of; stamp 0 is none.
  std::vector<ForcePair> pairs() const {
    std::map<ros::Time, double> felt;
    for (const auto& message : felt_.all()) felt[message->header.stamp] = message->wrench.force.z;
    std::vector<ForcePair> pairs;
    for (const auto& message : true_.all()) {
      const auto same = felt.find(message->header.stamp);
      if (!message->header.stamp.isZero() && same != felt.end())
        pairs.push_back({same->second, message->wrench.force.z});
    }
    return pairs;
  }
  static double largest(const std::vector<ForcePair>& pairs) {
    double largest = 0;
    for (const ForcePair& pair : pairs) largest = std::max(largest, pair.truth);
    return largest;
  }

 private:
  Probe<geometry_msgs::WrenchStamped>&felt_, &true_;
};

}  // namespace microinjection
