#include "vision/camera/camera_stream.h"

#include <cstring>
#include <utility>
#include <vector>

namespace microinjection {

/// Rows are compared, because an image may have gaps between them.
bool SameImage::operator()(const cv::Mat& a, const cv::Mat& b) const {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  const std::size_t width = a.elemSize() * static_cast<std::size_t>(a.cols);
  for (int row = 0; row < a.rows; ++row) {
    if (std::memcmp(a.ptr(row), b.ptr(row), width) != 0) return false;
  }
  return true;
}

CameraStream::CameraStream(const FrameSourceConfig& config, Open open)
    : is_device_(config.source == "device"), open_(std::move(open)) {
  this->open();
  period_ = source_->period();
}

void CameraStream::open() {
  source_ = open_();
  const std::vector<std::string> reports = source_->takeReports();
  if (!is_device_) {
    for (const std::string& report : reports) note(report);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ++state_.opened;
  if (!is_device_) return;
  state_.settings.clear();
  for (const std::string& report : reports) addSetting(report);
}

std::optional<CameraFrame> CameraStream::next() {
  if (!source_) {
    try {
      open();
    } catch (const std::exception& error) {
      note(error.what());
      return std::nullopt;
    }
  }
  std::optional<CameraFrame> frame;
  try {
    frame = source_->next();
  } catch (const std::exception& error) {  // OpenCV's, or of memory
    note(error.what());
  }
  // What a device says of a frame that it delivers is of its settings: the frames after it are no better.
  for (const std::string& report : source_->takeReports()) {
    if (!frame || !is_device_) note(report);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (frame && is_device_) addSetting(report);
  }
  if (!frame && is_device_) {
    source_.reset();
    return std::nullopt;
  }
  if (frame && is_device_ && repeats(*frame)) return std::nullopt;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (frame) {
    if (is_device_) state_.report.clear();  // it has recovered
    state_.has = source_->settings();
    ++state_.frames;
  } else {
    state_.ended = true;
  }
  return frame;
}

bool CameraStream::repeats(const CameraFrame& frame) {
  if (!images_.step(frame.image, 1)) return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++state_.repeated;
  return true;
}

void CameraStream::addSetting(const std::string& report) {
  state_.settings += (state_.settings.empty() ? "" : "; ") + report;
}

void CameraStream::note(const std::string& report) {
  const std::lock_guard<std::mutex> lock(mutex_);
  state_.report = report;
}

CameraStreamState CameraStream::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

}  // namespace microinjection
