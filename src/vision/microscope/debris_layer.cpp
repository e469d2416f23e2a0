#include "vision/microscope/debris_layer.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

using Value = EdgeResponse::Value;

/// Response of a disc at distance `r` (px) from its middle: that of a band as wide, reduced by what
/// the blur takes from a disc more than from a band.
class Disc {
 public:
  Disc(const EdgeResponse::Depth& depth, double radius, double blur)
      : depth_(depth), radius_(static_cast<float>(radius)) {
    const double ratio = radius / blur;
    share_ = static_cast<float>((1 - std::exp(-ratio * ratio / 2)) / std::erf(ratio / std::sqrt(2)));
  }
  Value at(float r) const { return share_ * (depth_.at(radius_ - r) + depth_.at(radius_ + r) - Value(1, 0)); }

 private:
  const EdgeResponse::Depth& depth_;
  float radius_;
  float share_;
};

/// A ring of absorption and a middle, both over the radius.
struct Pattern {
  double absorption;  ///< of the whole disc
  double inner;       ///< radius of the middle
  double middle;      ///< absorption of the middle, on top of the disc's
  double softness;    ///< rms width of the middle's border
  double phase;       ///< rad, of the disc
};

Pattern patternOf(Debris::Kind kind) {
  // Air turns away all light but that near the middle, where the bubble is a lens.
  if (kind == Debris::Kind::kBubble) return {0.9, 0.5, -1.1, 0.1, 0.5};
  return {0.5, 0.5, 0.2, 0.15, 0.6};
}

}  // namespace

void addDebris(const Debris& debris, double focus, const CameraView& view, const Optics& optics, OpticalImage& image) {
  const double defocus = debris.centre.y() - focus, blur = optics.blur(defocus);
  const EdgeResponse::Depth depth = optics.depth(defocus);
  const Pattern pattern = patternOf(debris.kind);
  const double radius = debris.radius / view.pixel_size;
  const double softness = radius * pattern.softness;
  const EdgeResponse::Depth soft = optics.depth(defocus, softness);
  const Disc whole(depth, radius, blur), middle(soft, radius * pattern.inner, std::hypot(blur, softness));
  const Eigen::Vector2d centre = view.pixelOf({debris.centre.x(), debris.centre.z()});
  const double reach = radius + depth.reach();
  const cv::Rect frame(cv::Point(0, 0), image.transmission.size());
  const Eigen::Array2d low = (centre.array() - reach).floor().max(0).min(1e6);
  const Eigen::Array2d high = (centre.array() + reach).ceil().max(-1).min(1e6);
  const cv::Rect region = cv::Rect(cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
                                   cv::Point(static_cast<int>(high.x()) + 1, static_cast<int>(high.y()) + 1)) &
                          frame;
  const auto contrast = static_cast<float>(optics.contrast());
  const auto absorption = static_cast<float>(pattern.absorption), focused = static_cast<float>(pattern.middle);
  const auto phase = static_cast<float>(pattern.phase);
  for (int y = region.y; y < region.y + region.height; ++y) {
    float* row = image.transmission.ptr<float>(y);
    float* path = image.path.empty() ? nullptr : image.path.ptr<float>(y);
    const double dy = y - centre.y();
    for (int x = region.x; x < region.x + region.width; ++x) {
      const auto r = static_cast<float>(std::hypot(x - centre.x(), dy));
      const Value disc = whole.at(r);
      const float change = -absorption * disc.real() - focused * middle.at(r).real() - phase * disc.imag();
      row[x] *= std::max(0.0F, 1 + contrast * change);
      if (path) path[x] += contrast * phase * disc.real();
    }
  }
}

}  // namespace microinjection
