#pragma once

#include <cell_microinjection/InjectionStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "nodes/runtime/master_monitor.h"
#include "vision/camera/video_file.h"

namespace microinjection {

/// Records the images with what was found in them: overlay.avi with overlay.avi.csv (time of each
/// frame), and a snapshot at each change of the injection's state.
///
/// In:  vision/image_overlay, /controller/injection_state
/// Out: files in output_dir
///
/// Parameters: config/image_recorder.yaml
class ImageRecorderNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError, WriteError when the folder cannot be written
  ImageRecorderNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  void onImage(const sensor_msgs::Image& message);
  void onState(const cell_microinjection::InjectionStatus& message);
  void saveSnapshot(const cv::Mat& image, const std::string& event);

  std::string folder_;
  double rate_ = 30;  ///< 1/s, at which a player shows the video
  std::unique_ptr<VideoFile> video_;
  std::string state_;                ///< of the injection
  std::vector<std::string> events_;  ///< whose snapshots are to be taken of the next image
  int snapshots_ = 0;
  std::string error_;  ///< of the last image; empty: written
  MasterMonitor master_{true};
  image_transport::ImageTransport transport_;
  image_transport::Subscriber images_;
  ros::Subscriber states_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
};

}  // namespace microinjection
