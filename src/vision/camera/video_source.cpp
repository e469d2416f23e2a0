#include "vision/camera/video_source.h"

#include "base/errors.h"
#include "base/range.h"

namespace microinjection {
namespace {

const Range kFileRate = Range::closed(1e-3, 1e5);  // 1/s; files without a rate claim 0 or a time base

}  // namespace

VideoSource::VideoSource(const std::string& path, double rate, bool loop) : path_(path), loop_(loop) {
  if (!capture_.open(path)) throw ConfigError(path + ": is no video that can be opened");
  if (rate == 0) rate = capture_.get(cv::CAP_PROP_FPS);
  if (!kFileRate.contains(rate)) throw ConfigError(path + ": has no frame rate of its own: set rate");
  period_ = 1 / rate;
}

std::optional<CameraFrame> VideoSource::next() {
  cv::Mat image;
  if (!capture_.read(image) && loop_ && of_loop_ > 0) {
    // Opened again, because not every container can seek to its first frame.
    of_loop_ = 0;
    if (!capture_.open(path_)) report(path_ + ": cannot be opened again");
    capture_.read(image);
  }
  if (image.empty()) {
    if (of_loop_ == 0) report(path_ + ": has no frame that can be decoded");
    return std::nullopt;
  }
  ++of_loop_;
  const long number = count_++;
  // The decoder may reuse its buffer for the next frame.
  return CameraFrame{image.clone(), static_cast<double>(number) * period_, std::to_string(number)};
}

}  // namespace microinjection
