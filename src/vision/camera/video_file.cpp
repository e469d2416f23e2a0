#include "vision/camera/video_file.h"

#include <iomanip>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"

namespace microinjection {

void VideoFile::open(const cv::Mat& frame) {
  size_ = frame.size();
  const int format = cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  if (!video_.open(path_, cv::CAP_OPENCV_MJPEG, format, rate_, size_))
    throw WriteError(path_, "the video cannot be opened");
  times_.open(path_ + ".csv");
  times_ << "frame,stamp\n" << std::fixed << std::setprecision(6);
  if (!times_.flush()) throw WriteError(path_ + ".csv", "the file refuses it");
}

void VideoFile::write(const cv::Mat& frame, double stamp) {
  if (frame.type() != CV_8UC1 && frame.type() != CV_8UC3)
    throw ConfigError("frame: must be of 8 bit, grey or BGR, to be recorded");
  if (frames_ > 0 && frame.size() != size_) throw ConfigError("frame: its size is not that of the first one");
  if (!video_.isOpened()) open(frame);
  cv::Mat colour = frame;
  if (frame.channels() == 1) cv::cvtColor(frame, colour, cv::COLOR_GRAY2BGR);
  video_.write(colour);
  times_ << frames_++ << ',' << stamp << '\n';
  if (!times_.flush()) throw WriteError(path_ + ".csv", "the file refuses it");
}

}  // namespace microinjection
