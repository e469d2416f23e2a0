#include "operation/console/axes_tasks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

AxesView answeredBridge() {
  AxesView axes;
  axes.there = axes.answered = true;
  axes.axes = "x -z y";
  return axes;
}

TEST(AxesTasks, NeedTheBridgeAndItsAnswer) {
  for (const AxesTask task : kAxesTasks) EXPECT_EQ(offer(task, {}).refusal, "no node haptic_bridge");
  AxesView axes = answeredBridge();
  axes.called = true;
  for (const AxesTask task : kAxesTasks) EXPECT_EQ(offer(task, axes).refusal, "the bridge is asked");
}

TEST(AxesTasks, NameTheNextMotion) {
  AxesView axes = answeredBridge();
  EXPECT_EQ(offer(AxesTask::kStep, axes).refusal, "");
  EXPECT_EQ(offer(AxesTask::kEnd, axes).refusal, "nothing to end");
  for (const char* next : {"right", "away", "up"}) {
    axes.next = next;
    EXPECT_NE(offer(AxesTask::kStep, axes).effect.find(next), std::string::npos);
    EXPECT_EQ(offer(AxesTask::kEnd, axes).refusal, "");
  }
}

TEST(AxesTasks, ShowTheResidualOrTheReason) {
  EXPECT_EQ(axesLamp({}).light, Light::kGrey);
  AxesView axes = answeredBridge();
  EXPECT_EQ(axesLamp(axes).text, "axes x -z y");
  axes.angle_to_axis = 4.1 * M_PI / 180;
  axes.angle_to_square = 3 * M_PI / 180;
  EXPECT_EQ(axesLamp(axes).light, Light::kGreen);
  EXPECT_EQ(axesLamp(axes).text, "axes x -z y; off axis 4.1, off square 3.0 degrees");
  axes.next = "away";
  EXPECT_EQ(axesLamp(axes).light, Light::kYellow);
  axes.refusal = "the hand moved 4.0 mm: move it 10 mm or more";
  EXPECT_EQ(axesLamp(axes).light, Light::kRed);
  EXPECT_EQ(axesLamp(axes).text, axes.refusal);
}

}  // namespace
}  // namespace microinjection
