#pragma once

#include <cell_microinjection/DisplayView.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <QCheckBox>
#include <QComboBox>
#include <QWidget>
#include <optional>

namespace microinjection {

/// What the scene shows of the cell: the meaning of its surface's colour, and whether it is cut open.
///
/// In: /viz/view. Out: /viz/set_view
class ViewRow : public QWidget {
 public:
  explicit ViewRow(QWidget* parent = nullptr);
  void start();
  /// Reads the messages that came, and shows the newest; grey until there is one.
  void refresh();

 private:
  void send();

  QComboBox* colours_;
  QCheckBox* section_;
  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Subscriber views_;
  ros::Publisher commands_;
};

}  // namespace microinjection
