#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "virtual_session.h"

namespace microinjection {

/// The test is the needle: it publishes the pose of the tip in each step.
class ScriptedNeedle {
 public:
  explicit ScriptedNeedle(VirtualSession& session, double height, const std::string& topic = "needle/measured_cp")
      : z(height), session_(session), topic_(topic) {
    publish();
  }

  /// What it publishes from now on: its pose; nothing; poses with stamp 0; this message, stamped with the time of each
  /// step.
  void publish() {
    session_.world().repeat<geometry_msgs::PoseStamped>(topic_, [this] { return std::optional(poseMessage(x, y, z)); });
  }
  void publishNothing() { session_.world().silence(topic_); }
  void publishInvalid() { session_.world().repeatInvalid(topic_, poseMessage(x, y, z)); }
  void publish(const geometry_msgs::PoseStamped& message) { session_.world().repeat(topic_, message); }

  /// Straight to a height (m) at `speed` (m/s), one pose each millisecond. `after`: is called after each of them.
  void moveTo(
      double goal, double speed, const std::function<void()>& after = [] {}) {
    const double start = z;
    const int steps = std::max(1, static_cast<int>(std::lround(1e3 * std::abs(goal - start) / speed)));
    for (int i = 1; i <= steps; ++i) {
      z = start + (goal - start) * i / steps;
      session_.run(1e-3);
      after();
    }
  }
  /// There at once, and `rest` (s).
  void jumpTo(double goal, double rest) {
    z = goal;
    session_.run(rest);
  }

  double x = 0, y = 0, z;  ///< m

 private:
  VirtualSession& session_;
  std::string topic_;
};

}  // namespace microinjection
