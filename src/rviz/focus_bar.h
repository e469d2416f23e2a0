#pragma once

#include <sensor_msgs/JointState.h>

#include <QWidget>
#include <memory>

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
  void start(Bus& bus);
  /// Shows the newest of the messages that were handled.
  void refresh();
  /// That many of the chosen steps, down where it is negative, if it is offered.
  void move(int steps);

 private:
  FocusView view() const;
  void onPosition(const sensor_msgs::JointState& message);

  JogRow* row_;
  FocusView focus_;
  double heard_at_ = -1e9, sent_at_ = -1e9;  ///< s, sessionNow()
  Bus* bus_ = nullptr;                       ///< null: not started
  Publisher<sensor_msgs::JointState> commands_;
  std::unique_ptr<ActionWatch> search_;
  Subscription positions_;
};

}  // namespace microinjection
