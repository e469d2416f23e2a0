// Writes the images that the segmentation network learns from to the standard output.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>

#include "base/parse_number.h"
#include "vision/segmentation/pixel_class.h"
#include "vision/segmentation/working_image.h"
#include "vision/segmentation_training/training_image.h"

namespace {

using namespace microinjection;

constexpr char kUsage[] =
    "usage: render_training_images FIRST COUNT\n"
    "       render_training_images --format\n"
    "Writes the training images of the seeds FIRST to FIRST + COUNT - 1 to the standard output: of each the planes of "
    "its\n"
    "working image and the label of the network's output, a byte a pixel, without anything between them.\n"
    "--format: the sizes, and the names of the classes in their order, as YAML.\n";

void writeFormat() {
  std::printf("width: %d\nheight: %d\nplanes: %d\nzero: %g\nunit: %g\nclasses:\n", WorkingImage::kWidth,
              WorkingImage::kHeight, WorkingImage::kPlanes, WorkingImage::kLevelOfZero, WorkingImage::kLevelsPerUnit);
  for (const char* name : kPixelClassNames) std::printf("  - %s\n", name);
}

bool write(const cv::Mat& plane) { return std::fwrite(plane.data, 1, plane.total(), stdout) == plane.total(); }

/// Returns whether all could be written: the reader may have left.
bool writeImages(std::uint64_t first, std::uint64_t count) {
  TrainingImages images;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const TrainingImage image = images.make(seed);
    cv::Mat grey;
    image.picture.convertTo(grey, CV_32F, 1 / 255.);
    const WorkingImage working(grey);
    for (const cv::Mat& plane : working.planes)
      if (!write(plane)) return false;
    if (!write(workingLabel(image.label, working))) return false;
  }
  return std::fflush(stdout) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const std::string first = argc > 1 ? argv[1] : "";
  if (argc == 2 && first == "--format") {
    writeFormat();
    return 0;
  }
  const auto seed = parseNumber<std::uint64_t>(first), count = parseNumber<std::uint64_t>(argc > 2 ? argv[2] : "");
  if (argc != 3 || !seed || !count) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    return writeImages(*seed, *count) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "render_training_images: " << error.what() << '\n';
    return 1;
  }
}
