#include "vision/microscope/optics.h"

#include <cmath>

namespace microinjection {
namespace {

// Gaussian that fits the Airy disc of incoherent light: 0.21 lambda / NA.
constexpr double kAiry = 0.21;
constexpr double kPixelVariance = 1.0 / 12;  // px^2, of the light gathered by a square pixel
// A body's phase is that of its border in bright field. DIC shows the whole of it (rad).
constexpr double kBodyPathPerPhase = 2.5;
constexpr double kPathPerDome = 20;       // rad per absorption
constexpr double kAbsorptionInDic = 0.4;  // its aperture is open, so that borders turn away less light

double square(double value) { return value * value; }

/// Rises from 0 at 0 to 1 at 1, without a slope at both ends, so that it displaces no edge.
double smoothRise(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Optics::Optics(const MicroscopeConfig& config)
    : contrast_mode_(config.contrast.mode),
      contrast_(config.contrast.strength),
      pixel_size_(config.camera.pixel_size),
      variance_in_focus_(
          square(kAiry * config.objective.wavelength / config.objective.numerical_aperture / pixel_size_) +
          kPixelVariance),
      // A uniform disc of radius r has the variance r^2 / 4 along each axis.
      slope_(config.objective.condenser_aperture / 2 / pixel_size_),
      diffraction_(config.objective.wavelength / (2 * M_PI) / square(pixel_size_)),
      halo_variance_(square(config.contrast.halo / pixel_size_)) {}

double Optics::blur(double defocus) const { return std::sqrt(variance_in_focus_ + square(slope_ * defocus)); }

EdgeResponse::Depth Optics::depth(double defocus, double softness) const {
  return response_.depth(square(blur(defocus)) + square(softness), diffraction_ * defocus);
}

EdgeResponse::Depth Optics::haloDepth(double defocus) const {
  return response_.depth(square(blur(defocus)) + halo_variance_, 0);
}

BorderProfile::BorderProfile(const Optics& optics, double defocus, const std::vector<Step>& steps, double dome,
                             double dome_width) {
  const EdgeResponse::Depth depth = optics.depth(defocus), halo = optics.haloDepth(defocus);
  const bool has_halo = optics.contrastMode() == ContrastMode::kPhase,
             dic = optics.contrastMode() == ContrastMode::kDic;
  double farthest = 0;
  for (const Step& step : steps) farthest = std::max(farthest, std::abs(step.inside));
  reach_ = std::max(farthest + std::max(depth.reach(), has_halo ? halo.reach() : 0.0), dome == 0 ? 0 : dome_width) + 1;
  const int entries = static_cast<int>(2 * reach_ * kPerPixel) + 3;
  last_ = static_cast<float>(entries - 2);
  for (int i = 0; i < entries; ++i) {
    const double distance = i / kPerPixel - reach_;
    const double rise = smoothRise(distance / dome_width);
    double change = -dome * rise, path = kPathPerDome * dome * rise;
    for (const Step& step : steps) {
      const auto u = static_cast<float>(distance - step.inside);
      const EdgeResponse::Value value = depth.at(u);
      change -= (dic ? kAbsorptionInDic : 1) * step.absorption * value.real();
      path += kBodyPathPerPhase * step.phase * value.real();
      if (has_halo) change -= step.phase * (value.real() - halo.at(u).real());
      if (!has_halo) change -= (dic ? 1 : 2) * step.phase * value.imag();
    }
    transmission_.push_back(static_cast<float>(change));
    path_.push_back(static_cast<float>(path));
    share_.push_back(depth.at(static_cast<float>(distance)).real());
  }
}

}  // namespace microinjection
