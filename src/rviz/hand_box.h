#pragma once

#include <cell_microinjection/LoopState.h>
#include <sensor_msgs/Joy.h>

#include <QWidget>
#include <optional>

#include "nodes/bus/bus.h"
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
  void start(Bus& bus);
  /// Shows the newest of the messages that were handled.
  void refresh();

 private:
  void readSettings();

  LampRow *follows_, *clutch_, *present_;
  ElidedLabel *position_, *force_;
  LinkBox* link_;
  HandView hand_;
  std::optional<double> heard_at_;  ///< s, of haptic_bridge
  Bus* bus_ = nullptr;              ///< null: not started
  Subscription loop_, clutches_, presences_;
};

}  // namespace microinjection
