#include "vision/microscope/bore_column_layer.h"

#include <algorithm>
#include <cmath>

#include "vision/microscope/cell_layer.h"
#include "vision/microscope/tube_shape.h"

namespace microinjection {
namespace {

class ColumnPicture {
 public:
  ColumnPicture(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                OpticalImage& image)
      : pipette_(pipette), view_(view), optics_(optics), image_(image), tube_(pipette, view) {
    const double in_image = Eigen::Vector2d(pipette.axis.x(), pipette.axis.z()).norm();
    length_ = pipette.column->length * in_image / view.pixel_size;
    bulge_ = pipette.column->bulge * in_image / view.pixel_size;
    radius_ = tube_.radiusAt(length_) * tube_.inner;
    defocus_ = pipette.tip.y() + pipette.axis.y() * pipette.column->length - focus;
  }

  void add(Texture& texture) {
    const BodyOptics& body = pipette_.column->optics;
    const BorderProfile profile(optics_, defocus_, borderSteps(body, optics_.pixelSize()), 0, 1);
    const EdgeResponse::Depth depth = optics_.depth(defocus_);
    const cv::Rect region = regionOf(std::max(profile.reach(), depth.reach()));
    if (region.empty()) return;
    const Eigen::Vector3d cap = pipette_.tip + pipette_.column->length * pipette_.axis;
    const cv::Mat grains = texture.sample(view_, region, {cap.x(), cap.z()}, pipette_.column->texture_seed,
                                          granuleBlur(optics_, defocus_));
    for (int y = 0; y < region.height; ++y) addRow(y, region, grains.ptr<float>(y), profile, depth);
  }

 private:
  /// The box of the column with `margin` px around it, within the image.
  cv::Rect regionOf(double margin) const {
    const auto wide = static_cast<float>(radius_ + margin);
    const Eigen::Vector2f across(-tube_.axis.y(), tube_.axis.x());
    const Eigen::Vector2f first = tube_.end - static_cast<float>(margin) * tube_.axis;
    const Eigen::Vector2f last = tube_.end + static_cast<float>(length_ + margin) * tube_.axis;
    std::vector<cv::Point2f> corners;
    for (const Eigen::Vector2f& end : {first, last}) {
      for (const float side : {-wide, wide})
        corners.emplace_back(end.x() + side * across.x(), end.y() + side * across.y());
    }
    Eigen::Vector2f low(1e9F, 1e9F), high = -low;
    for (const cv::Point2f& corner : corners) {
      low = low.cwiseMin(Eigen::Vector2f(corner.x, corner.y));
      high = high.cwiseMax(Eigen::Vector2f(corner.x, corner.y));
    }
    const auto inside = [](float value, int size) {
      return static_cast<int>(std::clamp(value, -1.0F, static_cast<float>(size) + 1));
    };
    const int left = inside(low.x(), view_.width), right = inside(high.x() + 2, view_.width);
    const int top = inside(low.y(), view_.height), bottom = inside(high.y() + 2, view_.height);
    return cv::Rect(left, top, right - left, bottom - top) & cv::Rect(0, 0, view_.width, view_.height);
  }

  /// px from the cap, a part of a sphere: positive towards the mouth. The column's side is no border.
  double behindCap(double s, double r) const {
    if (bulge_ == 0) return length_ - s;
    const double sphere = (radius_ * radius_ + bulge_ * bulge_) / (2 * bulge_), ahead = s - (length_ - sphere);
    return ahead > 0 ? sphere - std::hypot(ahead, r) : std::hypot(sphere - r, ahead);
  }

  void addRow(int row, const cv::Rect& region, const float* grains, const BorderProfile& profile,
              const EdgeResponse::Depth& depth) {
    const auto contrast = static_cast<float>(optics_.contrast());
    const auto granules = static_cast<float>(pipette_.column->optics.granules);
    float* transmission = image_.transmission.ptr<float>(row + region.y) + region.x;
    float* path = image_.path.empty() ? nullptr : image_.path.ptr<float>(row + region.y) + region.x;
    for (int x = 0; x < region.width; ++x) {
      const Eigen::Vector2f away =
          Eigen::Vector2f(static_cast<float>(x + region.x), static_cast<float>(row + region.y)) - tube_.end;
      const float s = away.dot(tube_.axis);
      const float r = std::abs(away.y() * tube_.axis.x() - away.x() * tube_.axis.y());
      const auto bore = static_cast<float>(tube_.radiusAt(s) * tube_.inner);
      const float within =
          depth.at(s).real() * (depth.at(bore - r) + depth.at(bore + r) - EdgeResponse::Value(1, 0)).real();
      if (within <= 0) continue;
      const auto distance = static_cast<float>(behindCap(s, r));
      const float own = granules * grains[x] * profile.share(distance);
      const float change = profile.transmission(distance) + (path ? 0 : own);
      transmission[x] *= std::max(0.0F, 1 + contrast * within * change);
      if (path) path[x] += within * contrast * (profile.path(distance) + static_cast<float>(kGranulePath) * own);
    }
  }

  const InjectionPipette& pipette_;
  const CameraView& view_;
  const Optics& optics_;
  OpticalImage& image_;
  TubeShape tube_;
  double length_, bulge_, radius_;  ///< px in the image: of the column, of its cap, of the bore at the cap
  double defocus_;                  ///< m, of the cap
};

}  // namespace

void addBoreColumn(const InjectionPipette& pipette, double focus, const CameraView& view, const Optics& optics,
                   Texture& texture, OpticalImage& image) {
  if (pipette.column) ColumnPicture(pipette, focus, view, optics, image).add(texture);
}

}  // namespace microinjection
