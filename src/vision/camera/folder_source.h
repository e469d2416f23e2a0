#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vision/camera/frame_source.h"
#include "vision/camera/image_file.h"

namespace microinjection {

/// Plays the images of a folder in natural order of their names, and all pages of a stack. Files without the name of an
/// image are passed over; an image that cannot be read is reported and skipped.
class FolderSource : public FrameSource {
 public:
  /// `rate` (1/s) above 0; `loop`: starts again at the end. Throws ConfigError when the folder is
  /// absent. A folder without images has no frames, and a report.
  FolderSource(const std::string& folder, double rate, bool loop);

  /// The stamp is the frame's number over the rate. It keeps rising from one loop to the next, and
  /// a skipped file has its time, too.
  std::optional<CameraFrame> next() override;
  double period() const override { return period_; }
  std::size_t size() const { return paths_.size(); }  ///< files of images in the folder, readable or not

 private:
  std::vector<std::string> paths_;
  double period_;  ///< s
  bool loop_;
  std::size_t position_ = 0;       ///< in paths_, of the next file
  std::optional<ImageFile> file_;  ///< the one before, when it has more pages
  std::size_t page_ = 0;           ///< of it, the next
  std::size_t count_ = 0;          ///< images passed since the start
};

}  // namespace microinjection
