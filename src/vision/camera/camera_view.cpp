#include "vision/camera/camera_view.h"

#include <cmath>

#include "base/config_errors.h"

namespace microinjection {
namespace {

constexpr double kLargestSide = 16384;  // px
const Range kViewSide = Range::closed(1, kLargestSide);
// From an electron microscope to a magnifying glass.
const Range kPixelSize = Range::closed(1e-9, 1e-3);       // m
const Range kAngle = Range::closed(-2 * M_PI, 2 * M_PI);  // rad
const Range kOrigin = Range::closed(-1e6, 1e6);           // px

}  // namespace

CameraView CameraView::read(ConfigReader& reader) {
  CameraView view;
  reader.integer("width", view.width, kViewSide);
  reader.integer("height", view.height, kViewSide);
  reader.number("pixel_size", view.pixel_size, kPixelSize);
  reader.number("angle", view.angle, kAngle);
  reader.boolean("mirrored", view.mirrored);
  view.origin = {(view.width - 1) / 2.0, (view.height - 1) / 2.0};
  reader.vector("origin", view.origin, kOrigin);
  return view;
}

void CameraView::validate() const {
  ConfigErrors errors("camera view");
  errors.require(kViewSide, "width", width, " px");
  errors.require(kViewSide, "height", height, " px");
  errors.require(kPixelSize, "pixel_size", pixel_size, " m");
  errors.require(kAngle, "angle", angle, " rad");
  errors.require(kOrigin, "origin x", origin.x(), " px");
  errors.require(kOrigin, "origin y", origin.y(), " px");
  errors.throwAny();
}

Eigen::Matrix2d CameraView::pixelsPerMetre() const {
  const double c = std::cos(angle), s = std::sin(angle), right = mirrored ? -1 : 1;
  Eigen::Matrix2d map;
  map << c * right, -s, -s * right, -c;
  return map / pixel_size;
}

Eigen::Vector2d CameraView::pixelOf(const Eigen::Vector2d& world) const { return origin + pixelsPerMetre() * world; }

Eigen::Vector2d CameraView::worldOf(const Eigen::Vector2d& pixel) const {
  // The map is a rotation, perhaps with a reflection, over the pixel size: its transpose inverts it.
  return pixelsPerMetre().transpose() * (pixel - origin) * (pixel_size * pixel_size);
}

Eigen::Vector2d CameraView::imageDirection(const Eigen::Vector2d& world) const {
  return (pixelsPerMetre() * world).normalized();
}

bool CameraView::contains(const Eigen::Vector2d& pixel) const {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= width - 1 && pixel.y() <= height - 1;
}

}  // namespace microinjection
