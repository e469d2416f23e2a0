#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <QWidget>
#include <memory>
#include <optional>

#include "operation/console/focus_steps.h"
#include "rviz/action_watch.h"
#include "rviz/jog_row.h"

namespace microinjection {

/// Moves the focus by steps: two buttons, and the wheel over the image while Ctrl is held. It appears with the first
/// position of a motor.
///
/// In: focus/measured_js (JointState), focus/find/status. Out: focus/move_jp (JointState)
class FocusBar : public QWidget {
 public:
  explicit FocusBar(QWidget* parent = nullptr);
  ~FocusBar() override;
  /// Connects to the session.
  void start();
  /// Reads the messages that came, and shows the newest.
  void refresh();
  /// That many of the chosen steps, down where it is negative, if it is offered.
  void move(int steps);

 private:
  FocusView view() const;
  void onPosition(const sensor_msgs::JointState& message);

  JogRow* row_;
  FocusView focus_;
  double heard_at_ = -1e9, sent_at_ = -1e9;  ///< s, sessionNow()
  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber positions_;
  ros::Publisher commands_;
  std::unique_ptr<ActionWatch> search_;
};

}  // namespace microinjection
