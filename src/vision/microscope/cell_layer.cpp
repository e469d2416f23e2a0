#include "vision/microscope/cell_layer.h"

#include <algorithm>

#include "vision/microscope/outline_distance.h"

namespace microinjection {
namespace {

constexpr double kDomeWidth = 20e-6;            // m, over which the thickness of a cell becomes that of its middle
constexpr double kLargestGranuleBlur = 0.8e-6;  // m rms

/// What belongs to one cell: changes add up in it, and the image is multiplied by it once.
class CellPicture {
 public:
  CellPicture(const CellScene& cell, double focus, const CameraView& view, const Optics& optics, Texture& texture,
              OpticalImage& image)
      : cell_(cell), defocus_(cell.y - focus), view_(view), optics_(optics), texture_(texture), image_(image) {}

  void add(const CellOutline& outline, const BodyOptics& body, double granules) {
    if (outline.empty()) return;
    const BorderProfile profile(optics_, defocus_, borderSteps(body, optics_.pixelSize()), body.dome,
                                kDomeWidth / optics_.pixelSize());
    std::vector<Eigen::Vector2d> corners;
    corners.reserve(outline.size());
    for (const Eigen::Vector2d& corner : outline) corners.push_back(view_.pixelOf(corner));
    const OutlineDistance border = outlineDistance(corners, profile.reach(), image_.transmission.size());
    if (border.region.empty()) return;
    reserve(border.region);
    cv::Mat grains;
    if (granules != 0) grains = grainsOf(border.region);
    addBorder(profile, border, grains, static_cast<float>(granules));
  }

  /// Multiplies the image by the cell.
  void finish() {
    if (region_.empty()) return;
    const auto contrast = static_cast<float>(optics_.contrast());
    cv::Mat target = image_.transmission(region_);
    for (int y = 0; y < target.rows; ++y) {
      const float* change = change_.ptr<float>(y);
      float* row = target.ptr<float>(y);
      for (int x = 0; x < target.cols; ++x) row[x] *= std::max(0.0F, 1 + contrast * change[x]);
    }
  }

 private:
  /// Makes room for changes in `region`.
  void reserve(const cv::Rect& region) {
    const cv::Rect whole = region_.empty() ? region : (region_ | region);
    if (whole == region_) return;
    cv::Mat wider(whole.size(), CV_32F, cv::Scalar(0));
    if (!region_.empty()) change_.copyTo(wider(region_ - whole.tl()));
    change_ = wider;
    region_ = whole;
  }

  cv::Mat grainsOf(const cv::Rect& region) {
    return texture_.sample(view_, region, cell_.material, cell_.texture_seed, granuleBlur(optics_, defocus_));
  }

  void addBorder(const BorderProfile& profile, const OutlineDistance& border, const cv::Mat& grains, float granules) {
    const bool dic = optics_.contrastMode() == ContrastMode::kDic;
    const auto grain_path = static_cast<float>(kGranulePath * optics_.contrast());
    const auto contrast = static_cast<float>(optics_.contrast());
    cv::Mat target = change_(border.region - region_.tl());
    for (int y = 0; y < target.rows; ++y) {
      const float* distance = border.distance.ptr<float>(y);
      const float* grain = grains.empty() ? nullptr : grains.ptr<float>(y);
      float* row = target.ptr<float>(y);
      float* path = dic ? image_.path.ptr<float>(y + border.region.y) + border.region.x : nullptr;
      for (int x = 0; x < target.cols; ++x) {
        row[x] += profile.transmission(distance[x]);
        const float own = grain ? granules * grain[x] * profile.share(distance[x]) : 0;
        if (dic) path[x] += contrast * profile.path(distance[x]) + grain_path * own;
        if (!dic) row[x] += own;
      }
    }
  }

  const CellScene& cell_;
  double defocus_;  ///< m
  const CameraView& view_;
  const Optics& optics_;
  Texture& texture_;
  OpticalImage& image_;
  cv::Rect region_;
  cv::Mat change_;  ///< CV_32F, of the transmission
};

}  // namespace

std::vector<BorderProfile::Step> borderSteps(const BodyOptics& body, double pixel_size) {
  return {{0, body.phase, body.absorption},
          {-body.rim_outside / pixel_size, 0, body.rim},
          {body.rim_inside / pixel_size, 0, -body.rim},
          {0, 0, -body.line},
          {body.line_width / pixel_size, 0, body.line}};
}

double granuleBlur(const Optics& optics, double defocus) {
  return std::min(optics.blur(defocus), std::max(optics.blur(0), kLargestGranuleBlur / optics.pixelSize()));
}

void addCell(const CellScene& cell, double focus, const CameraView& view, const Optics& optics, Texture& texture,
             OpticalImage& image) {
  CellPicture picture(cell, focus, view, optics, texture, image);
  picture.add(cell.zona_outer, cell.zona, cell.zona.granules);
  picture.add(cell.zona_inner, cell.perivitelline, -cell.zona.granules);
  if (const auto& body = cell.polar_body)
    picture.add(circleOutline(body->centre, body->radius, 256), body->optics, body->optics.granules);
  picture.add(cell.ooplasm, cell.cytoplasm, cell.cytoplasm.granules);
  if (const auto& body = cell.nucleus)
    picture.add(circleOutline(body->centre, body->radius, 256), body->optics, body->optics.granules);
  picture.finish();
}

}  // namespace microinjection
