#include "cell/estimation/puncture_prediction.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr int kPoints = 128;
constexpr int kDraws = 1000;
constexpr int kFewestDraws = 25;  ///< draws that are left: with fewer, the cell should have failed

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Indentation of the strain limit, m: the inverse of PunctureConfig::Layer::strainAt.
double depthOfStrain(const PunctureConfig::Layer& layer, double strain, double tip_radius) {
  const double width = layer.dimple_radius - tip_radius;
  return width * std::sqrt(std::max(0.0, (1 + strain) * (1 + strain) - 1));
}

}  // namespace

PuncturePredictor::PuncturePredictor(const Scene& scene, std::shared_ptr<const SurrogateData> cell, double deviation)
    : modulus_(scene.cell.material().young_modulus), tip_radius_(scene.needle.tip.radius), deviation_(deviation) {
  if (!scene.cell.puncture.layers.empty()) layer_ = scene.cell.puncture.layers.front();
  const double deepest = cell->range.axis_depth;
  SurrogateContact contact(scene, std::move(cell));
  depths_ = Eigen::VectorXd::LinSpaced(kPoints, 0, deepest);
  forces_.resize(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    forces_[i] = contact.step({0, 0, scene.radius() - depths_[i]}).force.z();
    if (i > 0) forces_[i] = std::max(forces_[i], forces_[i - 1]);
  }
}

double PuncturePredictor::forceAt(double depth) const {
  const double at = std::clamp(depth / depths_[kPoints - 1], 0.0, 1.0) * (kPoints - 1);
  const int i = std::min(static_cast<int>(at), kPoints - 2);
  return forces_[i] + (at - i) * (forces_[i + 1] - forces_[i]);
}

double PuncturePredictor::depthAt(double force) const {
  const double* above = std::upper_bound(forces_.data(), forces_.data() + kPoints, force);
  if (above == forces_.data()) return 0;
  if (above == forces_.data() + kPoints) return depths_[kPoints - 1];
  const auto i = above - forces_.data();
  const double share = (force - forces_[i - 1]) / (forces_[i] - forces_[i - 1]);
  return depths_[i - 1] + share * (depths_[i] - depths_[i - 1]);
}

std::optional<PuncturePrediction> PuncturePredictor::predict(double modulus, double modulus_deviation, double depth,
                                                             double share) const {
  if (!layer_) return std::nullopt;
  std::mt19937 random(1);  // the same draws each time: the prediction changes with what is known only
  std::normal_distribution<double> normal;
  std::vector<double> depths, forces;
  double beyond = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double strength = std::exp(deviation_ * normal(random));
    const double factor = modulus / modulus_ * std::exp(modulus_deviation * normal(random));
    double fails = depths_[kPoints - 1];
    if (std::isfinite(layer_->force)) fails = std::min(fails, depthAt(strength * layer_->force / factor));
    if (std::isfinite(layer_->depth)) fails = std::min(fails, strength * layer_->depth);
    if (std::isfinite(layer_->strain)) {
      fails = std::min(fails, depthOfStrain(*layer_, strength * layer_->strain, tip_radius_));
    }
    if (fails <= depth) continue;
    beyond += fails >= depths_[kPoints - 1];
    depths.push_back(fails);
    forces.push_back(factor * forceAt(fails));
  }
  if (static_cast<int>(depths.size()) < kFewestDraws) return std::nullopt;
  const double low = 0.5 * (1 - share), high = 0.5 * (1 + share);
  PuncturePrediction result;
  result.beyond = beyond / static_cast<double>(depths.size());
  result.depth = quantile(depths, 0.5);
  result.depth_low = quantile(depths, low);
  result.depth_high = quantile(depths, high);
  result.force = quantile(forces, 0.5);
  result.force_low = quantile(forces, low);
  result.force_high = quantile(forces, high);
  return result;
}

}  // namespace microinjection
