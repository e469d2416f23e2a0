#include "benchmark/common/recorded_indentation.h"

namespace microinjection {

ForceCurve recordIndentation(const DrawnCell& truth, double contact, double depth, FaultySensor& sensor,
                             std::mt19937& random) {
  const double offset = uniform(-100e-9, 100e-9, random);
  ForceCurve curve;
  const int count = static_cast<int>(FaultySensor::kRate * (contact + depth) / kRecordSpeed);
  for (int i = 0; i < count; ++i) {
    const double time = i / FaultySensor::kRate;
    const auto reading = sensor.read(
        time, [&](double at) { return truth.force(kRecordSpeed * at - contact); }, random);
    if (!reading) continue;
    curve.time.push_back(time);
    curve.position.push_back(kRecordSpeed * time);
    curve.force.push_back(*reading + offset);
  }
  return curve;
}

}  // namespace microinjection
