#include "vision/segmentation_training/label_image.h"

#include <cmath>
#include <opencv2/core.hpp>

#include "vision/microscope/outline_distance.h"
#include "vision/microscope/tube_shape.h"

namespace microinjection {
namespace {

constexpr double kLeastDebris = 0.8;  // px, radius

unsigned char valueOf(PixelClass pixel_class) { return static_cast<unsigned char>(pixel_class); }

void fillCell(const CellScene& cell, const CameraView& view, cv::Mat& label) {
  fillOutline(cell.zona_outer, view, PixelClass::kZona, label);
  fillOutline(cell.zona_inner, view, PixelClass::kPerivitellineSpace, label);
  if (const auto& body = cell.polar_body)
    fillOutline(circleOutline(body->centre, body->radius, 128), view, PixelClass::kPolarBody, label);
  fillOutline(cell.ooplasm, view, PixelClass::kOoplasm, label);
}

/// `glass` is the wall. What is in the bore keeps its class, or becomes `bore` where it was background.
void fillTube(const TubeShape& tube, PixelClass glass, PixelClass bore, cv::Mat& label) {
  for (int y = 0; y < label.rows; ++y) {
    unsigned char* row = label.ptr<unsigned char>(y);
    for (int x = 0; x < label.cols; ++x) {
      const Eigen::Vector2f from = Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - tube.end;
      const double s = from.dot(tube.axis);
      if (s < 0) continue;
      const double r = std::abs(from.y() * tube.axis.x() - from.x() * tube.axis.y()), radius = tube.radiusAt(s);
      if (r >= radius || (s < tube.lip && s < tube.lipAt(r))) continue;
      if (r >= radius * tube.inner || bore == glass) {
        row[x] = valueOf(glass);
      } else if (row[x] == valueOf(PixelClass::kBackground)) {
        row[x] = valueOf(bore);
      }
    }
  }
}

void fillDebris(const Debris& debris, const CameraView& view, cv::Mat& label) {
  if (debris.radius / view.pixel_size < kLeastDebris) return;
  const PixelClass kind = debris.kind == Debris::Kind::kBubble ? PixelClass::kBubble : PixelClass::kDebris;
  fillOutline(circleOutline({debris.centre.x(), debris.centre.z()}, debris.radius, 64), view, kind, label);
}

}  // namespace

void fillOutline(const CellOutline& outline, const CameraView& view, PixelClass value, cv::Mat& label) {
  if (outline.empty()) return;
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector2d& corner : outline) corners.push_back(view.pixelOf(corner));
  const OutlineDistance border = outlineDistance(corners, 1, label.size());
  if (!border.region.empty()) label(border.region).setTo(valueOf(value), border.distance > 0);
}

cv::Mat labelImage(const MicroscopeScene& scene, const CameraView& view) {
  cv::Mat label(view.height, view.width, CV_8U, cv::Scalar(valueOf(PixelClass::kBackground)));
  for (const CellScene& cell : scene.cells) fillCell(cell, view, label);
  if (scene.holding)
    fillTube(TubeShape(*scene.holding, view), PixelClass::kHoldingPipette, PixelClass::kBoreMedium, label);
  if (scene.injection)
    fillTube(TubeShape(*scene.injection, view), PixelClass::kInjectionPipette, PixelClass::kInjectionPipette, label);
  for (const Debris& debris : scene.debris) fillDebris(debris, view, label);
  return label;
}

}  // namespace microinjection
