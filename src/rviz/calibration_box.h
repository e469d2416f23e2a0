#pragma once

#include <QPushButton>
#include <QWidget>
#include <array>
#include <functional>
#include <memory>

#include "operation/console/camera_tasks.h"
#include "rviz/elided_label.h"
#include "rviz/lamp_row.h"

namespace microinjection {

class CameraTaskRunners;

/// Buttons for what is done with needle and camera before an injection: focus, calibrate, re-zero and
/// touch, each with its effect or the reason why it is greyed; progress and result of the last one.
class CalibrationBox : public QWidget {
 public:
  /// `newest`: gives the session at the moment of a press.
  explicit CalibrationBox(std::function<SessionView()> newest, QWidget* parent = nullptr);
  ~CalibrationBox() override;
  /// Connects to the actions: other consoles have no use for their messages.
  void start();
  /// Reads the messages that came, and shows the newest.
  void refresh(const SessionView& session);

 private:
  struct Row {
    QPushButton* button = nullptr;
    ElidedLabel* text = nullptr;
    bool offered = false;
  };
  void press(CameraTask task);
  static void display(Row& row, bool offered, const std::string& text);

  std::function<SessionView()> newest_;
  std::unique_ptr<CameraTaskRunners> runners_;
  std::array<Row, kCameraTasks.size()> rows_;
  Row cancel_;
  LampRow* report_;
};

}  // namespace microinjection
