#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>

#include "operation/console/camera_tasks.h"
#include "rviz/task_runner.h"

namespace microinjection {

/// Starts the tasks of needle and camera, and follows them.
///
/// Actions: /focus/find, /calibration/calibrate, /touch/find; the services /calibration/rezero,
/// /calibration/undo, /vision/measure_cell
///
/// Nothing here waits: the panel with the stop button lives in the same thread.
class CameraTaskRunners {
 public:
  CameraTaskRunners();
  ~CameraTaskRunners();

  /// Runs the callbacks of the messages that came.
  void poll();
  bool there(CameraTask task) const;
  /// The task under way, started here.
  std::optional<CameraTask> running() const;
  const CameraTaskReport& report() const { return report_; }
  void start(CameraTask task);
  void cancel();

 private:
  struct ServiceAnswer;
  void end(CameraTask task, bool success, const std::string& message);
  void progress(CameraTask task, const std::string& text);
  void call(CameraTask task);
  template <typename Service>
  static void call(const std::string& name, Service& service, ServiceAnswer& answer);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber vision_;
  std::array<std::unique_ptr<TaskRunner>, kCameraTasks.size()> runners_;  ///< null: of a service
  std::shared_ptr<ServiceAnswer> answer_;                                 ///< of a call under way
  CameraTaskReport report_;
};

}  // namespace microinjection
