#pragma once

#include <cell_microinjection/CalibrateForce.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <QWidget>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "operation/console/sensor_tasks.h"
#include "rviz/lamp_row.h"
#include "rviz/offer_row.h"

class QDoubleSpinBox;

namespace microinjection {

/// Buttons for tare and gain of the force sensor, each with its effect or the reason why it is greyed, and the residual
/// of the last step.
///
/// In: /diagnostics; services /force_sensor/tare, /force_sensor/calibrate, called from a thread: the stop button lives
/// in the caller's.
class SensorBox : public QWidget {
 public:
  explicit SensorBox(QWidget* parent = nullptr);
  ~SensorBox() override;
  /// Subscribes: other consoles have no use for the messages.
  void start();
  /// Reads the messages that came, and shows the newest.
  void refresh();

 private:
  struct Answer;
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void press(SensorTask task);
  SensorView view() const;

  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber reports_;
  std::optional<double> heard_at_;  ///< s
  SensorView sensor_;
  std::shared_ptr<Answer> answer_;  ///< of a call under way; shared with its thread, which may outlive the panel
  std::vector<OfferRow> rows_;
  QDoubleSpinBox *along_, *across_;  ///< uN
  LampRow* report_;
};

}  // namespace microinjection
