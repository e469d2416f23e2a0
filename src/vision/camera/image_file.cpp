#include "vision/camera/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace microinjection {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::array<unsigned char, 2> kJpegStart{0xFF, 0xD8}, kJpegScan{0xFF, 0xDA}, kJpegEnd{0xFF, 0xD9};
constexpr std::array<unsigned char, 4> kPngStart{0x89, 'P', 'N', 'G'}, kPngEnd{'I', 'E', 'N', 'D'};

template <typename Mark>
bool startsWith(const Bytes& bytes, const Mark& mark) {
  return bytes.size() >= mark.size() && std::equal(mark.begin(), mark.end(), bytes.begin());
}

template <typename Mark>
Bytes::const_iterator lastOf(const Bytes& bytes, const Mark& mark) {
  return std::find_end(bytes.begin(), bytes.end(), mark.begin(), mark.end());
}

/// Whether the file ends before its image does. A JPEG file may have a preview with an end of its
/// own, so that the end must follow the last scan.
bool isTruncated(const Bytes& bytes) {
  if (startsWith(bytes, kPngStart)) return lastOf(bytes, kPngEnd) == bytes.end();
  if (!startsWith(bytes, kJpegStart)) return false;  // other decoders report it themselves
  const auto scan = lastOf(bytes, kJpegScan), end = lastOf(bytes, kJpegEnd);
  return scan == bytes.end() || end == bytes.end() || end < scan;
}

}  // namespace

bool hasImageName(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::vector<std::string> names = {".png", ".jpg", ".jpeg", ".tif",  ".tiff", ".bmp",
                                                 ".pgm", ".ppm", ".pnm",  ".webp", ".jp2"};
  return std::find(names.begin(), names.end(), extension) != names.end();
}

LoadedImage loadImage(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {{}, "cannot be opened"};
  const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) return {{}, "cannot be read"};
  if (bytes.empty()) return {{}, "is empty"};
  if (isTruncated(bytes)) return {{}, "is truncated"};
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    return {{}, "cannot be decoded: " + std::string(error.err)};
  }
  if (image.empty()) return {{}, "is no image that can be decoded"};
  if (image.depth() != CV_8U && image.depth() != CV_16U) return {{}, "has neither 8 nor 16 bit"};
  if (image.channels() == 2) return {{}, "has 2 channels, allowed 1, 3 or 4"};
  return {image, ""};
}

}  // namespace microinjection
