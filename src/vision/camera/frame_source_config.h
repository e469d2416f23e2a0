#pragma once

#include <memory>
#include <string>

#include "vision/camera/device_source.h"
#include "vision/camera/frame_source.h"

namespace microinjection {

/// Which source of frames, and its settings.
struct FrameSourceConfig {
  std::string source = "device";  ///< device, folder or video
  std::string path;               ///< of the folder or the video
  double rate = 30;               ///< 1/s, of a recording; 0: the video's own
  bool loop = false;              ///< a recording starts again at its end
  DeviceSourceConfig device;

  /// Reads source; of a folder or a video path, rate and loop, of a device its section `device`.
  static FrameSourceConfig read(ConfigReader& reader);
  void validate() const;
};

/// Throws ConfigError for a bad configuration and for what cannot be opened.
std::unique_ptr<FrameSource> makeFrameSource(const FrameSourceConfig& config);

}  // namespace microinjection
