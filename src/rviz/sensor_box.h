#pragma once

#include <cell_microinjection/CalibrateForce.h>

#include <QWidget>
#include <memory>
#include <string>
#include <vector>

#include "operation/console/sensor_tasks.h"
#include "rviz/background_call.h"
#include "rviz/lamp_row.h"
#include "rviz/node_diagnostics.h"
#include "rviz/number_field.h"
#include "rviz/offer_row.h"

namespace microinjection {

/// Buttons for tare and gain of the force sensor, each with its effect or the reason why it is greyed, and the residual
/// of the last step.
///
/// In: /diagnostics; services /force_sensor/tare, /force_sensor/calibrate, called as BackgroundCall.
class SensorBox : public QWidget {
 public:
  explicit SensorBox(QWidget* parent = nullptr);
  ~SensorBox() override;
  /// Subscribes: other consoles have no use for the messages.
  void start(const std::shared_ptr<Bus>& bus);
  /// Shows the newest of the messages that were handled.
  void refresh();

 private:
  void read(const diagnostic_msgs::DiagnosticStatus& status);
  void press(SensorTask task);
  SensorView view() const;

  std::shared_ptr<Bus> bus_;  ///< null: not started
  NodeDiagnostics diagnostics_;
  SensorView sensor_;
  BackgroundCall<std::string> call_;  ///< the reason for a refusal
  std::vector<OfferRow> rows_;
  NumberField *along_, *across_;  ///< uN
  LampRow* report_;
};

}  // namespace microinjection
