#pragma once

#include <fstream>
#include <opencv2/videoio.hpp>
#include <string>

namespace microinjection {

/// Writes a video (Motion JPEG in AVI, which OpenCV writes by itself), and beside it a table with the
/// time of each frame: `frame,stamp`. A player shows the frames at `rate`; the table has their true
/// times.
class VideoFile {
 public:
  /// `path` ends in .avi; the table is PATH.csv. Nothing is written before the first frame. `rate`:
  /// 1/s, nominal.
  VideoFile(const std::string& path, double rate) : path_(path), rate_(rate) {}

  /// `frame`: CV_8UC1 or CV_8UC3, all of one size; `stamp`: s. Throws WriteError when the file cannot
  /// be written, and ConfigError for another format or size.
  void write(const cv::Mat& frame, double stamp);
  int frames() const { return frames_; }

 private:
  void open(const cv::Mat& frame);

  std::string path_;
  double rate_;
  cv::VideoWriter video_;
  std::ofstream times_;
  cv::Size size_;
  int frames_ = 0;
};

}  // namespace microinjection
