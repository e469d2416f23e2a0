#pragma once

#include <random>

#include "benchmark/common/drawn_cell.h"
#include "benchmark/common/faulty_sensor.h"
#include "cell/identification/force_curve.h"

namespace microinjection {

constexpr double kRecordSpeed = 20e-6;  ///< m/s, of the needle in a record

/// The record of a needle that goes in at kRecordSpeed: the sensor's readings with an offset of up to
/// 100 nN that is drawn. `contact`: m, position at the first contact; `depth`: m, past it.
ForceCurve recordIndentation(const DrawnCell& truth, double contact, double depth, FaultySensor& sensor,
                             std::mt19937& random);

}  // namespace microinjection
