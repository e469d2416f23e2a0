#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vision/frame/contrast_mode.h"
#include "vision/microscope/edge_response.h"
#include "vision/microscope/microscope_config.h"

namespace microinjection {

/// An image under construction, CV_32F and of the camera's size.
struct OpticalImage {
  cv::Mat transmission;  ///< share of the illumination
  cv::Mat path;          ///< rad, phase of the light; of dic only, otherwise empty
};

/// What the objective and the contrast mode make of an edge, in pixels. Every object of a scene consists of edges,
/// steps of phase and of absorption, and the image of a step is its convolution with a Gaussian of complex variance
/// (EdgeResponse):
///
///     s^2 = blur^2 + i lambda z / (2 pi)       z: distance behind the plane in focus
///     blur^2 = (0.21 lambda / NA)^2 + (z condenser aperture / 2)^2 + a pixel's
///
///     bright field    - a Re F - 2 p Im F            a: absorption, p: phase of the step; F: response at a pixel
///     phase           - a Re F - p (Re F - Re H)     H: the response with the blur of the halo
///     DIC             - 0.4 a Re F - p Im F          times 1 + the derivative of 2.5 p Re F along the shear
///
/// A picture's truth matters more here than its realism, because the detectors are tested with it and the network of
/// the second eye is trained with it. F is odd about the edge, so a blur of any size widens a border and leaves it
/// where the scene has it, to 0.02 px in focus (doc/design/microscope.md). Refraction of what lies behind an object,
/// which a propagation of the light through the scene would show, is left out.
class Optics {
 public:
  /// @pre `config` is valid (MicroscopeConfig::validate)
  explicit Optics(const MicroscopeConfig& config);

  ContrastMode contrastMode() const { return contrast_mode_; }
  double contrast() const { return contrast_; }
  double pixelSize() const { return pixel_size_; }  ///< m
  /// px, rms blur of an object at distance `defocus` (m) behind (positive) or before the plane in
  /// focus.
  double blur(double defocus) const;
  /// The edge response of an object at this distance (m); lengths in px. `softness` (px rms): blur of
  /// the object itself.
  EdgeResponse::Depth depth(double defocus, double softness = 0) const;
  /// The response to the light that a phase ring lets through beside the specimen, px.
  EdgeResponse::Depth haloDepth(double defocus) const;

 private:
  EdgeResponse response_;
  ContrastMode contrast_mode_;
  double contrast_;
  double pixel_size_;         ///< m
  double variance_in_focus_;  ///< px^2
  double slope_;              ///< px rms per m
  double diffraction_;        ///< px^2 per m: wavelength / (2 pi) over the pixel's area
  double halo_variance_;      ///< px^2
};

/// A border that consists of steps in phase and absorption, tabulated over the signed distance from it: a rim or a
/// line along the border is a pair of steps. A cell's border is thus one profile over the distance of each pixel to
/// its outline, so that any deformed outline can be rendered.
class BorderProfile {
 public:
  struct Step {
    double inside;      ///< px, distance of the step from the border
    double phase;       ///< rad, added on its inner side
    double absorption;  ///< share of the light
  };

  /// `defocus`: m, see Optics. `dome` adds an absorption which rises smoothly to its value at `dome_width` px inside.
  /// @pre dome_width > 0
  BorderProfile(const Optics& optics, double defocus, const std::vector<Step>& steps, double dome, double dome_width);

  double reach() const { return reach_; }  ///< px, beyond which nothing changes
  /// Of a pixel at `distance` px inside (positive) or outside the border: change of the transmission,
  /// phase of the light (rad), and share of the body's own texture.
  float transmission(float distance) const { return lookUp(transmission_, distance); }
  float path(float distance) const { return lookUp(path_, distance); }
  float share(float distance) const { return lookUp(share_, distance); }

 private:
  float lookUp(const std::vector<float>& table, float distance) const {
    const float place = std::clamp((distance + static_cast<float>(reach_)) * kPerPixel, 0.0F, last_);
    const int i = static_cast<int>(place);
    return table[i] + (place - static_cast<float>(i)) * (table[i + 1] - table[i]);
  }

  static constexpr float kPerPixel = 16;  // entries of the tables
  double reach_;
  float last_;  ///< place from which on the last entry holds
  std::vector<float> transmission_, path_, share_;
};

}  // namespace microinjection
