#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vision/camera/tiff_pages.h"

namespace microinjection {

/// An image, or the reason why there is none.
struct LoadedImage {
  cv::Mat image;        ///< 8 or 16 bit with 1, 3 or 4 channels, as in the file; empty when refused
  std::string refusal;  ///< empty when there is an image
};

/// Whether the file's name ends like that of an image.
bool hasImageName(const std::string& path);

/// An image file, which may be a stack: a TIFF file of several pages. Thumbnails are no pages.
class ImageFile {
 public:
  /// Does not throw: load() has the reason why there is no image.
  explicit ImageFile(const std::string& path);

  std::size_t pages() const { return tiff_ && !tiff_->empty() ? tiff_->size() : 1; }
  /// Reads a page, from 0. Refuses files that are absent, empty, truncated, no image, or not of 8 or 16 bit without
  /// sign. Where 0 is white (TIFF), the grey levels are turned. Does not throw. The decoders fill the missing part of a
  /// truncated JPEG or PNG file with grey: the end of the file is checked here.
  LoadedImage load(std::size_t page) const;
  /// The file's name without its folder; of a stack with the page: "stack.tif, page 2 of 3".
  std::string nameOf(std::size_t page) const;

 private:
  std::string path_;
  std::optional<std::vector<TiffPage>> tiff_;  ///< none: another format
};

/// Reads a file of one image. A stack is refused, whose other pages would be left out.
LoadedImage loadImage(const std::string& path);

}  // namespace microinjection
