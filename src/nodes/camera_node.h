#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "nodes/bus/diagnostics.h"
#include "nodes/imaging/image_output.h"
#include "vision/camera/camera_stream.h"

namespace microinjection {

/// A real camera of the microscope, or a recording of one, through OpenCV.
///
/// Out: microscope/image_raw, microscope/camera_info
///
/// Parameters: config/camera.yaml
///
/// The stamp is the time of exposure where the driver tells it (V4L2), else that of arrival. Frames
/// that a stopped driver repeats are not published. In virtual time there are only recordings.
class CameraNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range, the source cannot be opened, or
  /// is a device in virtual time.
  explicit CameraNode(Bus& bus);
  /// Ends the process when the device's read still blocks after a second: nothing can interrupt it.
  ~CameraNode();
  CameraNode(const CameraNode&) = delete;
  CameraNode& operator=(const CameraNode&) = delete;

 private:
  void grab();  ///< in its own thread, because a device blocks
  void publish(const CameraFrame& frame);
  ros::Time exposureTime(const CameraFrame& frame) const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Bus& bus_;
  double silence_ = 1;  ///< s without a frame that are an error
  std::unique_ptr<CameraStream> stream_;
  ImageOutput images_;
  std::atomic<std::int64_t> published_{0};  ///< ns of the steady clock, of the last frame
  unsigned reported_frames_ = 0;
  ros::SteadyTime reported_;
  Diagnostics diagnostics_;
  BusHandle timer_;
  BusHandle frames_;  ///< timer of a recording, in virtual time
  std::atomic<bool> stop_{false}, stopped_{false};
  std::thread thread_;
};

}  // namespace microinjection
