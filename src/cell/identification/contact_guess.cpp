#include "cell/identification/contact_guess.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr std::size_t kSamples = 400;  ///< are enough to guess
constexpr int kCandidates = 80;
constexpr double kPower = 1.5;      ///< of the depth
constexpr double kLeastSize = 6;    ///< of the force at the deepest sample, over the noise of a mean of ten
constexpr double kLeastGain = 0.5;  ///< of the squared residual, against a straight line
constexpr std::size_t kFilter = 2;  ///< neighbours on each side, of a median that removes outliers

struct Fit {
  double contact = 0, squares = std::numeric_limits<double>::infinity();
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();  ///< offset, drift, coefficient of the power
  double noise = 0;
};

/// Weights would take the few samples in contact for outliers, so that outliers are removed before.
ForceCurve withoutOutliers(ForceCurve curve) {
  const std::vector<double> force = curve.force;
  for (std::size_t i = kFilter; i + kFilter < force.size(); ++i) {
    const auto at = force.begin() + static_cast<std::ptrdiff_t>(i);
    curve.force[i] = upperMedian({at - kFilter, at + kFilter + 1});
  }
  return curve;
}

/// With a contact outside of the record there is no power.
Fit fitAt(const ForceCurve& curve, double contact, bool drift) {
  const auto count = static_cast<Eigen::Index>(curve.size());
  Eigen::MatrixX3d columns = Eigen::MatrixX3d::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double depth = (curve.position[k] - contact) * 1e6;
    columns.row(i) << 1, drift ? curve.time[k] - curve.time.front() : 0, depth > 0 ? std::pow(depth, kPower) : 0;
  }
  const Eigen::VectorXd force = Eigen::Map<const Eigen::VectorXd>(curve.force.data(), count);
  Fit fit;
  fit.contact = contact;
  fit.coefficients = columns.completeOrthogonalDecomposition().solve(force);
  const Eigen::VectorXd residual = force - columns * fit.coefficients;
  fit.squares = residual.squaredNorm();
  fit.noise = std::sqrt(fit.squares / static_cast<double>(count));
  return fit;
}

/// Deviation of a sample from its neighbours: no force of the cell changes it.
double noiseOfNeighbours(const ForceCurve& curve) {
  std::vector<double> differences;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    differences.push_back(std::abs(curve.force[i] - 0.5 * (curve.force[i - 1] + curve.force[i + 1])));
  }
  return 1.4826 * upperMedian(differences) / std::sqrt(1.5);
}

}  // namespace

ContactGuess guessContact(const ForceCurve& whole, bool drift) {
  const ForceCurve curve = averaged(withoutOutliers(whole), kSamples);
  const auto [low, high] = std::minmax_element(curve.position.begin(), curve.position.end());
  const Fit none = fitAt(curve, *high, drift);
  Fit best;
  for (int i = 0; i < kCandidates; ++i) {
    const Fit fit = fitAt(curve, *low + (*high - *low) * i / kCandidates, drift);
    if (fit.coefficients[2] > 0 && fit.squares < best.squares) best = fit;
  }
  ContactGuess guess;
  const auto [least, most] = std::minmax_element(whole.force.begin(), whole.force.end());
  guess.noise = std::max(noiseOfNeighbours(whole), kLeastRelativeNoise * (*most - *least));
  if (!std::isfinite(best.squares)) {
    guess.reason = "no contact: the force grows with no depth";
    return guess;
  }
  guess.contact = best.contact;
  guess.offset = best.coefficients[0];
  guess.drift = best.coefficients[1];
  guess.depth = *std::max_element(whole.position.begin(), whole.position.end()) - best.contact;
  guess.size = best.coefficients[2] * std::pow(1e6 * guess.depth, kPower);
  const double gain = 1 - best.squares / none.squares;
  char text[200];
  std::snprintf(text, sizeof(text),
                "no contact: the force rises by %.3g nN, its scatter is %.3g nN; a contact explains %.0f %% of it",
                1e9 * guess.size, 1e9 * best.noise, 100 * gain);
  guess.touched = guess.size > kLeastSize * best.noise && gain > kLeastGain;
  if (guess.touched && guess.size < whole.drag) {
    std::snprintf(text, sizeof(text),
                  "no contact: the force rises by %.3g nN; far from the cell, ways in and out differ by %.3g nN",
                  1e9 * guess.size, 1e9 * whole.drag);
    guess.touched = false;
  }
  if (!guess.touched) guess.reason = text;
  return guess;
}

}  // namespace microinjection
