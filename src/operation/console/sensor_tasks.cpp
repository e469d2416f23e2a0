#include "operation/console/sensor_tasks.h"

namespace microinjection {
namespace {

/// In the order of SensorTask.
const CommandOffer kSensorOffers[] = {{"Tare", "", "nothing touches the tip", ""},
                                      {"Point", "", "the force below acts now", ""},
                                      {"Gain", "", "fits the gain to the points", ""},
                                      {"Undo", "", "takes back the last step", ""}};

}  // namespace

/// The node's words, of ForceReadout.
bool SensorView::averaging() const { return outcome == "taring" || outcome == "averaging under the known force"; }

CommandOffer offer(SensorTask task, const SensorView& sensor) {
  CommandOffer result = kSensorOffers[static_cast<std::size_t>(task)];
  if (!sensor.there) {
    result.refusal = "no node force_sensor";
  } else if (sensor.called) {
    result.refusal = "the sensor is asked";
  } else if (sensor.averaging()) {
    result.refusal = "an average is under way";
  } else if (task == SensorTask::kGain && sensor.points == 0) {
    result.refusal = "add a point first";
  }
  return result;
}

/// The node's words, of ForceReadout.
bool SensorView::aborted() const { return outcome.rfind("the average was aborted", 0) == 0; }

Lamp sensorLamp(const SensorView& sensor) {
  if (!sensor.refusal.empty()) return {Light::kRed, sensor.refusal};
  if (!sensor.there || sensor.outcome.empty()) return {Light::kGrey, "nothing was calibrated in this session"};
  if (sensor.aborted()) return {Light::kRed, sensor.outcome};
  return {sensor.averaging() ? Light::kYellow : Light::kGreen, sensor.outcome};
}

}  // namespace microinjection
