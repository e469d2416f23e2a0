#pragma once

#include <memory>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/camera/frame_source.h"

namespace microinjection {

/// A camera behind OpenCV's VideoCapture. What is absent keeps the device's own setting.
struct DeviceSourceConfig {
  std::string device = "0";        ///< index, path such as /dev/video0, or a GStreamer pipeline (with "!")
  int width = 0;                   ///< px; 0: the device's own
  int height = 0;                  ///< px; 0: the device's own
  std::string format;              ///< FOURCC, for example MJPG or Y16; empty: the device's own
  double rate = 0;                 ///< 1/s; 0: the device's own
  std::optional<double> exposure;  ///< in the driver's unit (V4L2: 1e-4 s); turns automatic exposure off
  std::optional<double> gain;      ///< in the driver's unit

  static DeviceSourceConfig read(ConfigReader& reader);
  void validate() const;
  bool changesSettings() const;  ///< whether any setting of the device is given
};

/// Frames of a camera. What was asked of it is read back when it is opened, with its first frame, which is when some
/// drivers settle it, and now and then later: somebody may turn a knob. A GStreamer pipeline ends in an appsink. Its
/// settings belong in its text: OpenCV would stop the pipeline to change them.
class DeviceSource : public FrameSource {
 public:
  /// Throws ConfigError when the device cannot be opened. Reports every setting that the device
  /// refused, with the value that it has instead.
  explicit DeviceSource(const DeviceSourceConfig& config);
  /// Takes a device that is open.
  DeviceSource(const DeviceSourceConfig& config, std::unique_ptr<cv::VideoCapture> capture);

  /// Waits for the device's next frame. The stamp is the driver's, if it has one.
  std::optional<CameraFrame> next() override;
  double period() const override { return 0; }
  std::string settings() const override { return settings_; }

 private:
  void configure();
  struct Setting {
    int property;
    std::string key, unit;
    double asked, has;  ///< when it was last read
  };
  void set(int property, const std::string& key, double value, const std::string& unit);
  void readBack();
  void checkSize(const cv::Size& size);

  DeviceSourceConfig config_;
  std::unique_ptr<cv::VideoCapture> capture_;
  std::vector<Setting> asked_;
  std::string settings_;
  cv::Size size_;         ///< px, of the last frame
  bool is_deep_ = false;  ///< its format has more than 8 bit
  long count_ = 0;
};

}  // namespace microinjection
