#include "vision/camera/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace microinjection {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::array<unsigned char, 2> kJpegStart{0xFF, 0xD8}, kJpegScan{0xFF, 0xDA}, kJpegEnd{0xFF, 0xD9};
constexpr unsigned kSigned = 2, kFloatingPoint = 3;  // sample formats of TIFF
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

/// @param decode  returns an image, or an empty one
template <typename Decode>
LoadedImage decoded(const Decode& decode) {
  cv::Mat image;
  try {
    image = decode();
  } catch (const cv::Exception& error) {
    return {{}, "cannot be decoded: " + std::string(error.err)};
  }
  if (image.empty()) return {{}, "is no image that can be decoded"};
  if (image.depth() != CV_8U && image.depth() != CV_16U) return {{}, "has neither 8 nor 16 bit"};
  if (image.channels() == 2) return {{}, "has 2 channels, allowed 1, 3 or 4"};
  return {image, ""};
}

/// The decoder takes signed levels for unsigned ones, and turns those of 8 bit only where 0 is white.
LoadedImage loadTiff(const std::string& path, const TiffPage& page, std::size_t pages) {
  if (page.described > pages)
    return {{},
            "is a stack of ImageJ of " + std::to_string(page.described) + " images, of which a TIFF reader sees " +
                std::to_string(pages) + ": save it as an image sequence"};
  if (page.sample_format == kFloatingPoint) return {{}, "has grey levels of floating point, allowed 8 or 16 bit"};
  if (page.sample_format == kSigned) return {{}, "has grey levels with a sign, allowed 8 or 16 bit without"};
  LoadedImage loaded = decoded([&] {
    std::vector<cv::Mat> images;
    cv::imreadmulti(path, images, static_cast<int>(page.directory), 1, cv::IMREAD_UNCHANGED);
    return images.empty() ? cv::Mat() : images.front();
  });
  if (page.min_is_white && loaded.image.depth() == CV_16U) cv::bitwise_not(loaded.image, loaded.image);
  return loaded;
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

ImageFile::ImageFile(const std::string& path) : path_(path), tiff_(tiffPages(path)) {}

std::string ImageFile::nameOf(std::size_t page) const {
  const std::string name = std::filesystem::path(path_).filename().string();
  if (pages() == 1) return name;
  return name + ", page " + std::to_string(page + 1) + " of " + std::to_string(pages());
}

LoadedImage ImageFile::load(std::size_t page) const {
  std::ifstream file(path_, std::ios::binary);
  if (!file) return {{}, "cannot be opened"};
  if (page >= pages()) return {{}, "has no page " + std::to_string(page + 1)};
  if (tiff_ && tiff_->empty()) return {{}, "is truncated or damaged"};
  if (tiff_) return loadTiff(path_, (*tiff_)[page], tiff_->size());
  const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) return {{}, "cannot be read"};
  if (bytes.empty()) return {{}, "is empty"};
  if (isTruncated(bytes)) return {{}, "is truncated"};
  return decoded([&] { return cv::imdecode(bytes, cv::IMREAD_UNCHANGED); });
}

LoadedImage loadImage(const std::string& path) {
  const ImageFile file(path);
  if (file.pages() > 1) return {{}, "has " + std::to_string(file.pages()) + " pages, allowed 1"};
  return file.load(0);
}

}  // namespace microinjection
