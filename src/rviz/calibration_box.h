#pragma once

#include <QWidget>
#include <functional>
#include <memory>
#include <vector>

#include "nodes/bus/bus.h"
#include "operation/console/camera_tasks.h"
#include "rviz/lamp_row.h"
#include "rviz/offer_row.h"

namespace microinjection {

class CameraTaskRunners;

/// Buttons for what is done with needle and camera before an injection: focus, calibrate, re-zero,
/// undo, touch and measure, each with its effect or the reason why it is greyed; progress and result of the last one.
class CalibrationBox : public QWidget {
 public:
  /// `newest`: gives the session at the moment of a press.
  explicit CalibrationBox(std::function<SessionView()> newest, QWidget* parent = nullptr);
  ~CalibrationBox() override;
  /// Connects to the actions: other consoles have no use for their messages.
  void start(const std::shared_ptr<Bus>& bus);
  /// Shows the newest of the messages that were handled.
  void refresh(const SessionView& session);

 private:
  void press(CameraTask task);

  std::function<SessionView()> newest_;
  std::unique_ptr<CameraTaskRunners> runners_;
  std::vector<OfferRow> rows_;  ///< of the tasks, in their order
  OfferButton* cancel_;
  LampRow* report_;
};

}  // namespace microinjection
