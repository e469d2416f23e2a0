#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace microinjection {

/// An image, or the reason why there is none.
struct LoadedImage {
  cv::Mat image;        ///< 8 or 16 bit with 1, 3 or 4 channels, as in the file; empty when refused
  std::string refusal;  ///< empty when there is an image
};

/// Whether the file's name ends like that of an image.
bool hasImageName(const std::string& path);

/// Reads an image file. Refuses files that are absent, empty, truncated, no image, or not of 8 or
/// 16 bit. Does not throw. The decoders fill the missing part of a truncated JPEG or PNG file with
/// grey: the end of the file is checked here.
LoadedImage loadImage(const std::string& path);

}  // namespace microinjection
