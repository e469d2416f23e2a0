#include "operation/console/sensor_tasks.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

SensorView readySensor() {
  SensorView sensor;
  sensor.there = true;
  return sensor;
}

TEST(SensorTasks, NeedTheNodeAndAPoint) {
  for (const SensorTask task : kSensorTasks) EXPECT_EQ(offer(task, {}).refusal, "no node force_sensor");
  SensorView sensor = readySensor();
  EXPECT_EQ(offer(SensorTask::kTare, sensor).refusal, "");
  EXPECT_EQ(offer(SensorTask::kGain, sensor).refusal, "add a point first");
  sensor.points = 1;
  EXPECT_EQ(offer(SensorTask::kGain, sensor).refusal, "");
}

TEST(SensorTasks, WaitForAnAverageAndForAnAnswer) {
  SensorView sensor = readySensor();
  sensor.points = 1;
  for (const char* outcome : {"taring", "averaging under the known force"}) {
    sensor.outcome = outcome;
    EXPECT_EQ(sensorLamp(sensor).light, Light::kYellow);
    for (const SensorTask task : kSensorTasks) EXPECT_EQ(offer(task, sensor).refusal, "an average is under way");
  }
  sensor.outcome = "tared; noise 0.01, 0.24 uN rms";
  EXPECT_EQ(offer(SensorTask::kUndo, sensor).refusal, "");
  sensor.called = true;
  for (const SensorTask task : kSensorTasks) EXPECT_EQ(offer(task, sensor).refusal, "the sensor is asked");
}

TEST(SensorTasks, ShowTheResidualOrTheReason) {
  SensorView sensor = readySensor();
  EXPECT_EQ(sensorLamp(sensor).light, Light::kGrey);
  sensor.outcome = "tared; noise 0.01, 0.24 uN rms";
  EXPECT_EQ(sensorLamp(sensor).light, Light::kGreen);
  EXPECT_EQ(sensorLamp(sensor).text, sensor.outcome);
  sensor.refusal = "there is no calibration point";
  EXPECT_EQ(sensorLamp(sensor).light, Light::kRed);
  EXPECT_EQ(sensorLamp(sensor).text, sensor.refusal);
}

}  // namespace
}  // namespace microinjection
