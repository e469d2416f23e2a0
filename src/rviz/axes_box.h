#pragma once

#include <cell_microinjection/CalibrateAxes.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <QWidget>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "operation/console/axes_tasks.h"
#include "rviz/lamp_row.h"
#include "rviz/offer_row.h"

namespace microinjection {

/// Buttons for the axes of the haptic device, each with its effect or the reason why it is greyed, and the residual of
/// the motions so far.
///
/// In: /diagnostics; service /haptic_bridge/calibrate_axes, called from a thread: the stop button lives in the
/// caller's.
class AxesBox : public QWidget {
 public:
  explicit AxesBox(QWidget* parent = nullptr);
  ~AxesBox() override;
  /// Subscribes: other consoles have no use for the messages.
  void start();
  /// Reads the messages that came, and shows the newest.
  void refresh();

 private:
  struct Answer;
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void press(AxesTask task);
  void take(const Answer& answer);
  AxesView view() const;

  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber reports_;
  std::optional<double> heard_at_;  ///< s
  AxesView axes_;
  std::shared_ptr<Answer> answer_;  ///< of a call under way; shared with its thread, which may outlive the panel
  std::vector<OfferRow> rows_;
  LampRow* report_;
};

}  // namespace microinjection
