#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

constexpr double kPeriod = 1e-3;                       // s
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();  // of the pipette

inline Scene pipette() {
  Scene scene;
  scene.needle.tip.shape = "hemisphere";
  return scene;
}

/// A cell with an energy of t^2 alone: isotropic springs in the scaled coordinates.
inline std::shared_ptr<SurrogateData> springs(const Scene& scene) {
  auto cell = std::make_shared<SurrogateData>();
  cell->range = SurrogateRange::standard(scene);
  const SurrogatePlan plan = SurrogatePlan::plan(scene, cell->range);
  cell->energy = EnergyExpansion(plan.scales, {});
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(cell->energy.size());
  coefficients[0] = 1;
  cell->energy.setCoefficients(coefficients);
  return cell;
}

/// The same with a force field that differs from the energy's: more sideways by `more`, and so no gradient.
inline std::shared_ptr<SurrogateData> fieldOfSprings(const Scene& scene, double more) {
  auto cell = springs(scene);
  const SurrogatePlan plan = SurrogatePlan::plan(scene, cell->range);
  std::vector<TrainingSample> samples;
  for (double angle : {0.0, 0.3, 0.6, 0.9}) {
    EnergyExpansion::Local local;
    cell->energy.makeLocal(angle, local);
    for (int i = 1; i <= 8; ++i) {
      for (double tilt : {0.0, 0.3, 0.6, 0.9, 1.2}) {
        for (double turn : {0.0, 0.8, 1.6, 2.4, 3.1}) {
          const Eigen::Vector3d way(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), -std::cos(tilt));
          const Eigen::Vector3d u = 0.3e-6 * i * i * way;
          Eigen::Vector3d force = -local.evaluate(u).gradient;
          force.head<2>() *= 1 + more * way.z() * way.z();
          samples.push_back({angle, u, force, {}});
        }
      }
    }
  }
  cell->field = ForceField(plan.scales);
  cell->field.fit(samples);
  return cell;
}

}  // namespace microinjection
