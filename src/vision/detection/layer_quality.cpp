#include <algorithm>
#include <cmath>

#include "vision/detection/layer_solver.h"

namespace microinjection {
namespace {

constexpr double kBand = 8;  // px to both sides of a border, see misfit()

}  // namespace

double LayerSolver::cost() const {
  double sum = 0;
  for (const Point& point : points_) sum += std::log(scale_[point.inside ? 1 : 0]);
  return sum;
}

double LayerSolver::correlated() const {
  double product = 0, square = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (points_[i].sector != points_[i - 1].sector) continue;
    product += std::sqrt(weight_[i] * weight_[i - 1]) * residual_[i] * residual_[i - 1];
    square += weight_[i] * residual_[i] * residual_[i];
  }
  const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.9) : 0;
  return (1 + correlation) / (1 - correlation);
}

double LayerSolver::misfit(const LayerModel& model, const Eigen::VectorXd& parameters, int border) const {
  constexpr int kBins = 2 * static_cast<int>(kBand) + 1, kHarmonics = 3;
  double sum[kBins][kHarmonics] = {}, weight[kBins] = {};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (weight_[i] == 0) continue;
    const LayerModel::Sample& sample = points_[i].sample;
    const double place = border == 0 ? sample.harmonics.sum(parameters, LayerModel::kOuter, 5)
                                     : sample.ooplasm + sample.harmonics.sum(parameters, LayerModel::kOoplasm, 5);
    const int bin = static_cast<int>(std::lround(sample.place - place + kBand));
    if (bin < 0 || bin >= kBins) continue;
    // Samples of the inside have more texture and less weight: here each counts by its sector alone.
    const double scale = scale_[points_[i].inside ? 1 : 0], share = weight_[i] * scale * scale;
    const double rest = share * (points_[i].grey - model.value(parameters, sample));
    for (int k = 0; k < kHarmonics; ++k) sum[bin][k] += (k == 0 ? 1 : M_SQRT2) * rest * sample.harmonics.at[k];
    weight[bin] += share;
  }
  double square = 0;
  int bins = 0;
  for (int i = 0; i < kBins; ++i) {
    if (weight[i] < 1) continue;
    for (const double part : sum[i]) square += part * part / (weight[i] * weight[i]);
    ++bins;
  }
  return std::sqrt(square / std::max(bins, 1));
}

}  // namespace microinjection
