#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/repetition.h"
#include "vision/camera/frame_source.h"
#include "vision/camera/frame_source_config.h"

namespace microinjection {

/// Whether two images have the same bytes.
struct SameImage {
  bool operator()(const cv::Mat& a, const cv::Mat& b) const;
};

/// What a stream did since its start.
struct CameraStreamState {
  unsigned frames = 0;    ///< delivered
  unsigned repeated = 0;  ///< of a device, dropped because they were the last one again
  unsigned opened = 0;    ///< times that the source was opened
  bool ended = false;     ///< of a recording
  std::string report;     ///< the last one; empty: none
  std::string has;        ///< of a device: the settings that it says it has
  std::string settings;   ///< of a device: what is not as asked for, since it was opened; empty: nothing
};

/// Frames of a source, one after the other, at their pace.
///
/// A device that fails is opened again. A device without noise is frozen: a driver that has stopped
/// repeats its last buffer. Such frames are dropped, because nobody downstream could tell them from
/// new ones.
class CameraStream {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  /// `open` throws ConfigError when the source cannot be opened. The first time, this constructor
  /// does.
  CameraStream(const FrameSourceConfig& config, Open open);

  /// Waits for the next frame. None: there is none at the moment (a device that cannot be opened,
  /// or a repeated frame), or no more (ended).
  std::optional<CameraFrame> next();
  /// s from one frame to the next of a recording; 0 for a device.
  double period() const { return period_; }
  /// Of any thread.
  CameraStreamState state() const;

 private:
  void open();
  bool repeats(const CameraFrame& frame);
  void note(const std::string& report);
  void addSetting(const std::string& report);  ///< with the lock

  bool is_device_;
  Open open_;
  std::unique_ptr<FrameSource> source_;  ///< null: to be opened again
  double period_ = 0;
  Repetition<cv::Mat, SameImage> images_{0};  ///< of a device
  mutable std::mutex mutex_;
  CameraStreamState state_;
};

}  // namespace microinjection
