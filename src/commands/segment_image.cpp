// Shows what the learned eye sees: writes an image with the classes of its pixels as colours.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/command_line.h"
#include "base/cpu_time.h"
#include "base/errors.h"
#include "base/output_files.h"
#include "vision/camera/grey_image.h"
#include "vision/camera/image_file.h"
#include "vision/segmentation/segmenter.h"

namespace {

using namespace microinjection;

constexpr char kUsage[] =
    "usage: segment_image WEIGHTS IMAGE [OVERLAY.png]\n"
    "Prints the regions of each class (px of the image) as CSV, and writes the image with coloured classes.\n";

// BGR, in the order of PixelClass.
const cv::Vec3b kColours[kPixelClasses] = {{0, 0, 0},       {160, 0, 0},   {0, 200, 255},  {200, 200, 0},
                                           {40, 40, 230},   {255, 0, 255}, {255, 120, 60}, {0, 230, 0},
                                           {255, 255, 255}, {40, 90, 140}, {160, 255, 160}};

void printRegions(const Segmentation& segmentation, const std::string& name,
                  std::initializer_list<PixelClass> classes) {
  for (const ClassRegion& region : segmentation.regions(classes))
    std::printf("%s,%.1f,%.1f,%.1f,%.3f,%d\n", name.c_str(), region.centre.x, region.centre.y, region.diameter,
                region.probability, region.touches_border ? 1 : 0);
}

cv::Mat overlayOf(const cv::Mat& image, const Segmentation& segmentation) {
  cv::Mat grey, overlay;
  cv::cvtColor(toGrey8(toGrey(image), 0.005), overlay, cv::COLOR_GRAY2BGR);
  for (int y = 0; y < overlay.rows; ++y) {
    for (int x = 0; x < overlay.cols; ++x) {
      const cv::Point2d place = segmentation.fromFrame(cv::Point2d(x, y));
      const int column = std::clamp(static_cast<int>(std::lround(place.x)), 0, Segmentation::kWidth - 1);
      const int row = std::clamp(static_cast<int>(std::lround(place.y)), 0, Segmentation::kHeight - 1);
      const int value = segmentation.classes().at<unsigned char>(row, column);
      if (value == 0) continue;
      cv::Vec3b& pixel = overlay.at<cv::Vec3b>(y, x);
      pixel = 0.6 * pixel + 0.4 * kColours[value];
    }
  }
  return overlay;
}

void run(const std::string& weights, const std::string& path, const std::string& out) {
  OutputFiles().reads("WEIGHTS", weights).reads("IMAGE", path).writes("OVERLAY", out).check();
  const LoadedImage loaded = loadImage(path);
  if (!loaded.refusal.empty()) throw ConfigError(loaded.refusal);
  const Frame frame(loaded.image);
  if (!frame.refusal().empty()) throw ConfigError(path + ": " + frame.refusal());
  Segmenter segmenter(weights);
  const double began = threadCpuTime();
  const Segmentation segmentation = segmenter.segment(frame);
  std::fprintf(stderr, "%s: %.1f ms\n", path.c_str(), 1e3 * (threadCpuTime() - began));
  std::printf("class,x,y,diameter,probability,touches_border\n");
  for (std::size_t i = 1; i < kPixelClasses; ++i)
    printRegions(segmentation, kPixelClassNames[i], {static_cast<PixelClass>(i)});
  printRegions(segmentation, "cell",
               {PixelClass::kZona, PixelClass::kPerivitellineSpace, PixelClass::kOoplasm, PixelClass::kPolarBody});
  if (!out.empty() && !cv::imwrite(out, overlayOf(loaded.image, segmentation))) throw WriteError(out, "not an image");
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  if (argc != 3 && argc != 4) {
    std::fputs(kUsage, stderr);
    return kBadUsage;
  }
  return runProgram("segment_image", [&] {
    run(argv[1], argv[2], argc > 3 ? argv[3] : "");
    return kDone;
  });
}
