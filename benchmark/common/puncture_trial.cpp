#include "benchmark/common/puncture_trial.h"

#include <cmath>

#include "base/errors.h"
#include "benchmark/common/faulty_sensor.h"
#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/puncture_prediction.h"
#include "cell/family/family_cell.h"

namespace microinjection {
namespace {

constexpr double kSpeed = 20e-6, kApproach = 10e-6;  // m/s, m
constexpr double kSurface = 0.2e-6;                  // m rms, of the surface above where it is modelled
constexpr double kShallowest = 4e-6;                 // m, of a puncture that the law says
constexpr double kDeepest = 0.5;                     // of the prepared depth: a stronger cell fails deeper
constexpr int kUpdate = 20;                          // readings from one update to the next

/// m, where the cell's force reaches `limit` (N), by bisection; the range's end for a larger force.
double depthOfForce(const DrawnCell& cell, double limit) {
  double low = 0, high = cell.length;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (cell.force(middle) < limit ? low : high) = middle;
  }
  return high;
}

/// A law that fails a cell of the usual strength at `depth` (m).
PunctureConfig::Layer drawLaw(const DrawnCell& cell, double depth, std::string& name, std::mt19937& random) {
  PunctureConfig::Layer layer;
  const double tip = cell.scene.needle.tip.radius;
  switch (std::uniform_int_distribution<int>(0, 2)(random)) {
    case 0:
      name = "force";
      layer.force = cell.force(depth);
      break;
    case 1:
      name = "depth";
      layer.depth = depth;
      break;
    default:
      name = "strain";
      layer.dimple_radius = uniform(2, 4, random) * tip;
      layer.strain = layer.strainAt(depth, tip);
  }
  return layer;
}

/// m, where a cell fails whose limits are those of the law times `factor`.
double failureDepth(const DrawnCell& cell, const PunctureConfig::Layer& law, double factor) {
  if (std::isfinite(law.force)) return depthOfForce(cell, factor * law.force);
  if (std::isfinite(law.depth)) return factor * law.depth;
  const double width = law.dimple_radius - cell.scene.needle.tip.radius;
  return width * std::sqrt(std::pow(1 + factor * law.strain, 2) - 1);
}

/// Indents the cell to `depth` (m).
CellEstimate learn(const DrawnCell& cell, const Scene& prior, const std::shared_ptr<const SurrogateData>& member,
                   double depth, int seed, std::mt19937& random) {
  FaultySensor sensor("none", 0, seed);
  CellEstimator estimator(prior, member, {});
  const double surface = std::normal_distribution<double>(0, kSurface)(random);
  const double offset = uniform(-50e-9, 50e-9, random);
  const int count = static_cast<int>(FaultySensor::kRate * (kApproach + depth) / kSpeed);
  for (int i = 0; i < count; ++i) {
    const double time = i / FaultySensor::kRate, travel = kSpeed * time - kApproach;
    const auto reading = sensor.read(
        time, [&](double at) { return cell.force(kSpeed * at - kApproach); }, random);
    estimator.add(time, {0, 0, cell.scene.radius() + surface - travel}, *reading + offset);
    if (i % kUpdate == 0) estimator.update();
  }
  return estimator.update();
}

}  // namespace

PunctureScore runPunctureTrial(const DrawnCell& cell, const std::shared_ptr<const FamilyData>& family, double strength,
                               int seed, std::mt19937& random) {
  PunctureScore score;
  Scene prior = cell.withModulus(std::exp(uniform(-1, 1, random)) * cell.modulus);
  const double usual = uniform(kShallowest, kDeepest * cell.length, random);
  const PunctureConfig::Layer law = drawLaw(cell, usual, score.law, random);
  prior.cell.puncture.layers = {law};
  score.depth = failureDepth(cell, law, std::exp(strength * std::normal_distribution<double>()(random)));
  const double force = cell.force(score.depth);
  std::string reason;
  const auto member = makeFamilyCell(family, prior, reason);
  if (!member) throw ConfigError("the prior has no member: " + reason);

  const CellEstimate found = learn(cell, prior, member->data, 0.5 * score.depth, seed, random);
  const PuncturePredictor predictor(prior, member->data, strength);
  const auto predict = [&](double share) {
    return predictor.predict(found.modulus, std::sqrt(found.covariance(0, 0)), found.depth, share);
  };
  const auto half = predict(0.5), most = predict(0.9);
  if (!half || !most) return score;
  score.predicted = true;
  score.force_error = half->force / force - 1;
  score.depth_error = half->depth / score.depth - 1;
  score.force_in_50 = half->force_low <= force && force <= half->force_high;
  score.force_in_90 = most->force_low <= force && force <= most->force_high;
  score.depth_in_50 = half->depth_low <= score.depth && score.depth <= half->depth_high;
  score.depth_in_90 = most->depth_low <= score.depth && score.depth <= most->depth_high;
  return score;
}

}  // namespace microinjection
