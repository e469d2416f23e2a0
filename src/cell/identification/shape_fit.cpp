#include "cell/identification/shape_fit.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kOutlier = 3;          ///< residual over its deviation from which a sample loses weight
constexpr double kContactScale = 1e-7;  ///< m, of a step of the contact
constexpr double kForce = 1e-8;         ///< N, of a step of offset and drift

using Unknowns = Eigen::Vector4d;  ///< ln(modulus), contact, offset, drift over the record

/// The normal equations about a fit, and its robust square.
struct Equations {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Unknowns right = Unknowns::Zero();
  double square = 0;

  void add(const Unknowns& row, double residual) {
    const double far = residual / kOutlier, weight = 1 / (1 + far * far);
    normal += weight * row * row.transpose();
    right += weight * residual * row;
    square += kOutlier * kOutlier * std::log1p(far * far);
  }
  void addPrior(int index, double unit, double value, double deviation) {
    normal(index, index) += std::pow(unit / deviation, 2);
    right[index] -= unit * value / deviation / deviation;
    square += std::pow(value / deviation, 2);
  }
};

double durationOf(const AxisSamples& samples) {
  return std::max(samples.time[samples.time.size() - 1] - samples.time[0], 1e-9);
}

Equations equationsOf(const AxisShape& shape, const AxisSamples& samples, const ShapeFitConfig& config,
                      const ShapeFit& fit) {
  Equations equations;
  const double duration = durationOf(samples);
  for (Eigen::Index i = 0; i < samples.force.size(); ++i) {
    const ElasticLaw::Value value = shape.at(samples.travel[i] - fit.contact);
    const double since = samples.time[i] - samples.time[0], force = fit.modulus * value.force;
    const Unknowns row(force, -kContactScale * fit.modulus * value.stiffness, kForce,
                       config.drift ? kForce * since / duration : 0);
    const double residual = samples.force[i] - force - fit.offset - fit.drift * since;
    equations.add(row / samples.deviation[i], residual / samples.deviation[i]);
  }
  equations.addPrior(1, kContactScale, fit.contact - config.contact, config.contact_deviation);
  equations.addPrior(2, kForce, fit.offset, config.offset_deviation);
  return equations;
}

}  // namespace

ShapeFit fitShape(const AxisShape& shape, const AxisSamples& samples, const ShapeFitConfig& config,
                  const ShapeFit& start, int steps) {
  constexpr double kLargest = 1;  // of the modulus's logarithm in a step
  ShapeFit fit = start;
  Equations equations = equationsOf(shape, samples, config, fit);
  fit.square = equations.square;
  double damping = 1e-6;
  for (int step = 0; step < steps; ++step) {
    Eigen::Matrix4d damped = equations.normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12;  // what is not fitted has no equation
    const Unknowns change = damped.ldlt().solve(equations.right);
    if (!change.allFinite()) break;
    ShapeFit next = fit;
    next.modulus *= std::exp(std::max(-kLargest, std::min(kLargest, change[0])));
    next.contact += kContactScale * change[1];
    next.offset += kForce * change[2];
    if (config.drift) next.drift += kForce * change[3] / durationOf(samples);
    const Equations at = equationsOf(shape, samples, config, next);
    next.square = at.square;
    if (at.square < equations.square) {
      const bool settled = equations.square - at.square < 1e-3;
      fit = next;
      equations = at;
      damping = std::max(1e-6, 0.1 * damping);
      if (settled) break;
    } else {
      damping = std::max(1e-2, 10 * damping);
    }
  }
  return fit;
}

Eigen::VectorXd forcesOf(const AxisShape& shape, const AxisSamples& samples, const ShapeFit& fit) {
  Eigen::VectorXd forces(samples.force.size());
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    forces[i] = fit.modulus * shape.at(samples.travel[i] - fit.contact).force + fit.offset +
                fit.drift * (samples.time[i] - samples.time[0]);
  }
  return forces;
}

}  // namespace microinjection
