#pragma once

#include <cell_microinjection/LoopState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <QWidget>
#include <optional>

#include "operation/console/hand_lines.h"

namespace microinjection {

class ElidedLabel;
class LampRow;
class LinkBox;

/// The haptic hand: whether the needle follows it, its clutch and dead-man switch, and its scales.
///
/// In: /haptic/loop_state, /haptic/clutch, /haptic/operator_present, the parameters of haptic_bridge
class HandBox : public QWidget {
 public:
  explicit HandBox(QWidget* parent = nullptr);
  /// Subscribes: a console without a hand has no use for the messages.
  void start();
  /// Reads the messages that came, and shows the newest.
  void refresh();

 private:
  void readSettings();

  LampRow *follows_, *clutch_, *present_;
  ElidedLabel *position_, *force_;
  LinkBox* link_;
  HandView hand_;
  std::optional<double> heard_at_;  ///< s, of haptic_bridge
  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber loop_, clutches_, presences_;
};

}  // namespace microinjection
