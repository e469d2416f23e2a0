#pragma once

#include <opencv2/videoio.hpp>
#include <string>

#include "vision/camera/frame_source.h"

namespace microinjection {

/// Plays a video file.
class VideoSource : public FrameSource {
 public:
  /// `rate` (1/s): 0 takes the file's own. `loop`: starts again at the end. Throws ConfigError when
  /// the file cannot be opened, or has no rate of its own and none is given.
  VideoSource(const std::string& path, double rate, bool loop);

  /// The stamp is the frame's number over the rate and keeps rising from one loop to the next.
  std::optional<CameraFrame> next() override;
  double period() const override { return period_; }

 private:
  std::string path_;
  cv::VideoCapture capture_;
  double period_;  ///< s
  bool loop_;
  long count_ = 0;    ///< frames since the start
  long of_loop_ = 0;  ///< frames since the file was opened
};

}  // namespace microinjection
