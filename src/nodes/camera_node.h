#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <atomic>
#include <memory>
#include <thread>

#include "nodes/imaging/image_output.h"
#include "nodes/runtime/master_monitor.h"
#include "vision/camera/camera_stream.h"

namespace microinjection {

/// A real camera of the microscope, or a recording of one, through OpenCV.
///
/// Out: microscope/image_raw, microscope/camera_info
///
/// Parameters: config/camera.yaml
///
/// The stamp is the time of exposure where the driver tells it (V4L2), else that of arrival. Frames
/// that a stopped driver repeats are not published.
class CameraNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range, or the source cannot be opened.
  CameraNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Ends the process when the device's read still blocks after a second: nothing can interrupt it.
  ~CameraNode();
  CameraNode(const CameraNode&) = delete;
  CameraNode& operator=(const CameraNode&) = delete;
  void run();

 private:
  void grab();  ///< in its own thread, because a device blocks
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  double silence_ = 1;  ///< s without a frame that are an error
  std::unique_ptr<CameraStream> stream_;
  ImageOutput images_;
  MasterMonitor master_{true};
  std::atomic<std::int64_t> published_{0};  ///< ns of the steady clock, of the last frame
  unsigned reported_frames_ = 0;
  ros::SteadyTime reported_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
  std::atomic<bool> stop_{false}, stopped_{false};
  std::thread thread_;
};

}  // namespace microinjection
