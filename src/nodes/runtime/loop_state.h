#pragma once

#include <string>

#include "cell_microinjection/LoopState.h"
#include "nodes/bus/bus.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Publishes on a latched topic whether a node follows its inputs: at each change, another reason
/// at most each 0.1 s, and each second.
class LoopStatePublisher {
 public:
  LoopStatePublisher(Bus& bus, const std::string& topic)
      : publisher_(bus.advertise<cell_microinjection::LoopState>(topic, 1, true)) {}

  /// `reason`: why the node holds; empty: it follows.
  void step(const std::string& reason, const ros::Time& now) {
    const bool changed = last_.header.stamp.isZero() || last_.follows != static_cast<unsigned char>(reason.empty());
    if (!changed && !isDue(last_.header.stamp, now, reason == last_.hold_reason ? 1 : 0.1)) return;
    last_.header.stamp = now;
    last_.follows = reason.empty();
    last_.hold_reason = reason;
    publisher_.publish(last_);
  }

 private:
  Publisher<cell_microinjection::LoopState> publisher_;
  cell_microinjection::LoopState last_;
};

}  // namespace microinjection
