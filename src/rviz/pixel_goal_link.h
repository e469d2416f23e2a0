#pragma once

#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/OperatingState.h>
#include <geometry_msgs/PointStamped.h>

#include <memory>
#include <string>

#include "nodes/bus/bus.h"
#include "operation/console/light.h"
#include "operation/console/pixel_goal.h"
#include "rviz/task_runner.h"

namespace microinjection {

/// Has the needle led to a pixel, and follows it on its way.
///
/// In:  controller/operating_state (at each change), controller/injection_state (ten times a second);
///      action: /visual_servo/go_to_pixel
/// Out: visual_servo/proposed_pixel (px; stamp 0: none), latched
///
/// A place is forgotten when the way to it ends, however it ends, when the controller leaves ENABLED,
/// and after a minute: nobody shall press Go for a click of long ago.
class PixelGoalLink {
 public:
  explicit PixelGoalLink(Bus& bus);
  ~PixelGoalLink();
  void poll();  ///< handles the messages that came

  const PixelGoal& goal() const { return goal_; }
  const Lamp& report() const { return report_; }  ///< of the last way
  CommandOffer offered() const;

  /// Nothing changes while the needle is on its way.
  void propose(const Eigen::Vector2d& pixel);
  void discard();
  /// Does what is offered, or nothing.
  void go();
  void cancel();

 private:
  class Runner;
  SessionView session() const;
  void publish();
  void onOperating(const cell_microinjection::OperatingState& message);
  void onInjection();
  void end(bool success, const std::string& message);

  Bus& bus_;
  PixelGoal goal_;
  Lamp report_;
  SessionView session_;
  double heard_at_ = -1e9, proposed_at_ = -1e9;  ///< s, sessionNow()
  Publisher<geometry_msgs::PointStamped> proposed_;
  Subscription operating_, injection_;
  std::unique_ptr<Runner> runner_;
};

}  // namespace microinjection
