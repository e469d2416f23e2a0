#pragma once

#include <cell_microinjection/InjectionStatus.h>
#include <sensor_msgs/Image.h>

#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/diagnostics.h"
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
  explicit ImageRecorderNode(Bus& bus);

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
  Subscription states_, images_;
  Diagnostics diagnostics_;
  BusHandle timer_;
};

}  // namespace microinjection
