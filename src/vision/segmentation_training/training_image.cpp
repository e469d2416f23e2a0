#include "vision/segmentation_training/training_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/microscope/cell_layer.h"
#include "vision/microscope/debris_layer.h"
#include "vision/microscope/optics.h"
#include "vision/microscope/pipette_layer.h"
#include "vision/segmentation_training/camera_effects.h"
#include "vision/segmentation_training/label_image.h"
#include "vision/segmentation_training/specimen_effects.h"
#include "vision/segmentation_training/training_scene.h"

namespace microinjection {
namespace {

constexpr double kTwoPanels = 0.03;  // probability
constexpr double kLargestShear = 1;  // of the light, by DIC

/// As Microscope::render does, without its camera, whose tables take longer than such an image.
cv::Mat render(const TrainingScene& drawn, RandomDraw& random, Texture& texture) {
  drawn.scene.validate();
  const CameraView& view = drawn.microscope.camera;
  const Optics optics(drawn.microscope);
  OpticalImage image;
  image.transmission = cv::Mat(view.height, view.width, CV_32F, cv::Scalar(1));
  const bool dic = optics.contrastMode() == ContrastMode::kDic;
  if (dic) image.path = cv::Mat(view.height, view.width, CV_32F, cv::Scalar(0));
  for (const CellScene& cell : drawn.scene.cells) addCell(cell, drawn.focus, view, optics, texture, image);
  if (drawn.scene.holding) addPipette(*drawn.scene.holding, drawn.focus, view, optics, image);
  if (drawn.scene.injection) addPipette(*drawn.scene.injection, drawn.focus, view, optics, image);
  for (const Debris& debris : drawn.scene.debris) addDebris(debris, drawn.focus, view, optics, image);
  if (!dic) return image.transmission;
  const double angle = drawn.microscope.contrast.shear_angle, strength = random.within(0.15, 0.6);
  const auto right = static_cast<float>(strength * std::cos(angle)),
             down = static_cast<float>(strength * std::sin(angle));
  cv::Mat shear;
  const cv::Matx33f derivative(0, -down, 0, -right, 0, right, 0, down, 0);
  cv::filter2D(image.path, shear, CV_32F, derivative, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
  cv::min(cv::max(shear, -kLargestShear), kLargestShear, shear);
  return image.transmission.mul(1 + shear);
}

}  // namespace

TrainingImage TrainingImages::panel(std::uint64_t seed) {
  RandomDraw random(seed);
  const TrainingScene drawn = drawTrainingScene(random);
  TrainingImage image;
  image.contrast_mode = drawn.microscope.contrast.mode;
  image.label = labelImage(drawn.scene, drawn.microscope.camera);
  cv::Mat light = render(drawn, random, texture_);
  addSpecimenEffects(random, light, image.label);
  image.picture = photograph(random, light, image.label);
  return image;
}

TrainingImage TrainingImages::make(std::uint64_t seed) {
  TrainingImage image = panel(seed);
  RandomDraw random(seed + 1);
  if (!random.chance(kTwoPanels)) return image;
  TrainingImage other = panel(random.bits());
  cv::resize(other.picture, other.picture, image.picture.size(), 0, 0, cv::INTER_LINEAR);
  cv::resize(other.label, other.label, image.label.size(), 0, 0, cv::INTER_NEAREST);
  cv::vconcat(image.picture, other.picture, image.picture);
  cv::vconcat(image.label, other.label, image.label);
  return image;
}

cv::Mat workingLabel(const cv::Mat& label, const WorkingImage& working) {
  cv::Mat result(WorkingImage::kHeight / 2, WorkingImage::kWidth / 2, CV_8U, cv::Scalar(kNoLabel));
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      const cv::Point2d middle(2 * x + 0.5, 2 * y + 0.5);
      if (!working.region.contains(cv::Point(2 * x, 2 * y))) continue;
      const cv::Point2d pixel = working.toImage(middle);
      result.at<unsigned char>(y, x) =
          label.at<unsigned char>(std::clamp(static_cast<int>(std::lround(pixel.y)), 0, label.rows - 1),
                                  std::clamp(static_cast<int>(std::lround(pixel.x)), 0, label.cols - 1));
    }
  }
  return result;
}

}  // namespace microinjection
