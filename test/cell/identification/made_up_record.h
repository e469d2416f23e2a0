#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "cell/identification/elastic_law.h"
#include "cell/identification/force_curve.h"
#include "cell/identification/formula_law.h"

namespace microinjection {

/// Hertz's law of a tip of 5 um.
inline std::shared_ptr<ElasticLaw> hertz() {
  FormulaGeometry geometry;
  geometry.tip_radius = 5e-6;
  return makeFormulaLaw("hertz", geometry);
}

/// A record of a needle that moves at 20 um/s from 3 um above a cell to 5 um below its surface, 1 kHz.
struct MadeUpRecord {
  double modulus = 2e3;     ///< Pa
  double contact = 3.1e-6;  ///< m
  double offset = -40e-9;   ///< N
  double drift = 0;         ///< N/s
  double noise = 2e-9;      ///< N
  double outliers = 0;      ///< share of the samples, 40 deviations off
  unsigned seed = 1;

  ForceCurve make(const ElasticLaw& law) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    ForceCurve curve;
    Eigen::VectorXd none;
    for (int i = 0; i < 405; ++i) {
      const double time = 1e-3 * i, position = 20e-6 * time, depth = position - contact;
      double force = offset + drift * time + noise * normal(random);
      if (depth > 0) force += modulus * law.force(depth, none).force;
      if (std::uniform_real_distribution<double>()(random) < outliers) force += 40 * noise * (i % 2 == 0 ? 1 : -1);
      curve.time.push_back(time);
      curve.position.push_back(position);
      curve.force.push_back(force);
    }
    return curve;
  }
};

}  // namespace microinjection
