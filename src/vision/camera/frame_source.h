#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace microinjection {

/// One image of a camera, as it came.
struct CameraFrame {
  cv::Mat image;                ///< 8 or 16 bit; grey, BGR or BGRA
  std::optional<double> stamp;  ///< s, when it was taken, on the source's own clock; none if the source has no clock
  std::string name;             ///< of its file, or its number
};

/// Where frames come from. Nothing here waits for the time of a frame: who calls next() keeps the
/// period.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Returns the next frame; none at the end, or when a device has stopped. What was skipped on the
  /// way is in takeReports().
  virtual std::optional<CameraFrame> next() = 0;
  /// s from one frame of a recording to the next; 0 for a device, which sets its own pace.
  virtual double period() const = 0;

  /// The settings that a device says it has: "1280 x 960 px, exposure 100, gain 0"; empty of a recording.
  virtual std::string settings() const { return ""; }

  /// Takes what was skipped or refused since the last call, a sentence each.
  std::vector<std::string> takeReports() { return std::exchange(reports_, {}); }

 protected:
  void report(const std::string& text) { reports_.push_back(text); }

 private:
  std::vector<std::string> reports_;
};

}  // namespace microinjection
