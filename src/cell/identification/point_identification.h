#pragma once

#include "cell/identification/identification.h"

namespace microinjection {

/// One published point of a force-depth curve.
struct MeasuredPoint {
  double depth = 0;          ///< m, from the contact
  double force = 0;          ///< N
  double reading_error = 0;  ///< relative, of the force: half of the interval of 95 %
  double depth_error = 0;    ///< m, same
};

/// The modulus with which a law goes through the point, with an interval from the errors of the reading,
/// the depth and the law. The contact is taken as known, and nothing tests the law: a note says so.
/// Throws ConfigError when the law does not reach the depth.
Identification identifyPoint(const MeasuredPoint& point, const ElasticLaw& law);

}  // namespace microinjection
