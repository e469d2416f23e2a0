#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "operation/console/camera_tasks.h"
#include "rviz/background_call.h"
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
  explicit CameraTaskRunners(const std::shared_ptr<Bus>& bus);
  ~CameraTaskRunners();

  /// Handles the messages that came.
  void poll();
  bool there(CameraTask task) const;
  /// The task under way, started here.
  std::optional<CameraTask> running() const;
  const CameraTaskReport& report() const { return report_; }
  void start(CameraTask task);
  void cancel();

 private:
  void end(CameraTask task, bool success, const std::string& message);
  void progress(CameraTask task, const std::string& text);
  void call(CameraTask task);

  std::shared_ptr<Bus> bus_;
  Subscription vision_;
  std::array<std::unique_ptr<TaskRunner>, kCameraTasks.size()> runners_;  ///< null: of a service
  BackgroundCall<std::pair<bool, std::string>> call_;                     ///< success and message
  CameraTaskReport report_;
};

}  // namespace microinjection
