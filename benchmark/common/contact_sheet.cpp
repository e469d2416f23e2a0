#include "benchmark/common/contact_sheet.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "benchmark/common/vision_cases.h"
#include "benchmark/common/vision_real.h"

namespace microinjection {
namespace {

constexpr int kColumns = 7, kText = 48;  // px, height of the three lines below a thumbnail
constexpr int kOfCondition = 2;
const cv::Size kThumbnail(400, 300);

std::string sheetVerdict(const std::string& thing, const Finding& finding) {
  return thing + (finding.isFound() ? " sure  " : finding.hasValues() ? " uncertain  " : " no  ");
}

void writeLine(cv::Mat& image, const std::string& words, int y) {
  cv::putText(image, words, {4, y}, cv::FONT_HERSHEY_SIMPLEX, 0.38, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
}

cv::Mat thumbnailOf(const SheetImage& image, const std::shared_ptr<SecondEye>& eye) {
  const Frame frame(image.image);
  SpecimenTracker tracker(image.config, eye);
  const SpecimenView& view = tracker.next(frame);
  const cv::Mat drawn = drawOverlay(frame, view.overlay());
  const double scale = std::min(1.0 * kThumbnail.width / drawn.cols, 1.0 * kThumbnail.height / drawn.rows);
  cv::Mat small, whole(kThumbnail.height + kText, kThumbnail.width, CV_8UC3, cv::Scalar(40, 40, 40));
  cv::resize(drawn, small, {}, scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  small.copyTo(whole(cv::Rect({0, 0}, small.size())));
  writeLine(whole, image.name, kThumbnail.height + 12);
  writeLine(whole,
            sheetVerdict("cell", view.cell.finding) + sheetVerdict("size", view.cell.size) +
                sheetVerdict("zona", view.cell.zona_outer.finding),
            kThumbnail.height + 27);
  writeLine(whole, sheetVerdict("tip", view.injection.finding) + sheetVerdict("mouth", view.holding.finding),
            kThumbnail.height + 42);
  return whole;
}

}  // namespace

std::vector<SheetImage> realSheet(const Micrographs& micrographs, bool second_eye) {
  std::vector<SheetImage> images;
  for (const std::string& name : micrographs.names()) {
    const MarkedImage image = micrographs.load(name);
    images.push_back({name, image.image, trackerConfig(image, second_eye ? RealSetup::kDefault : RealSetup::kTold)});
  }
  return images;
}

std::vector<SheetImage> renderedSheet(std::uint64_t first) {
  std::vector<SheetImage> images;
  for (const VisionCondition& condition : visionConditions()) {
    Microscope microscope(condition.microscope);
    for (std::uint64_t seed = first; seed < first + kOfCondition; ++seed)
      images.push_back({condition.name, renderedImage(condition, microscope, seed).image, trackerConfig(condition)});
  }
  return images;
}

cv::Mat contactSheet(const std::vector<SheetImage>& images, const std::shared_ptr<SecondEye>& eye) {
  const int rows = (static_cast<int>(images.size()) + kColumns - 1) / kColumns;
  const cv::Size cell(kThumbnail.width, kThumbnail.height + kText);
  cv::Mat sheet(rows * cell.height, kColumns * cell.width, CV_8UC3, cv::Scalar(0, 0, 0));
  int number = 0;
  for (const SheetImage& image : images) {
    const cv::Point corner((number % kColumns) * cell.width, (number / kColumns) * cell.height);
    thumbnailOf(image, eye).copyTo(sheet(cv::Rect(corner, cell)));
    ++number;
  }
  return sheet;
}

}  // namespace microinjection
