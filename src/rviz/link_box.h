#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>

#include <QWidget>
#include <memory>
#include <optional>

namespace microinjection {

class OfferRow;

/// Pulls the cable of an emulated network between hand and rig, and plugs it in again. Hidden without
/// such a network.
///
/// In, out: /link/plugged
class LinkBox : public QWidget {
 public:
  explicit LinkBox(QWidget* parent = nullptr);
  ~LinkBox() override;
  void start();
  /// Shows whether there is such a network, and whether it is plugged in.
  void refresh();

 private:
  void plug(bool in);

  std::unique_ptr<OfferRow> unplug_, plug_in_;
  std::optional<bool> plugged_;  ///< as the last message said; before the first it is not known
  int emulators_ = 0;            ///< connections of link_emulator to publisher_
  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
};

}  // namespace microinjection
