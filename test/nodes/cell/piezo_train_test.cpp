// What a piezo-driven needle does to the simulated cell, and which pulses are refused.

#include <gtest/gtest.h>

#include <cell_microinjection/CellState.h>
#include <cell_microinjection/PiezoPulses.h>

#include "scripted_needle.h"

namespace microinjection {
namespace {

cell_microinjection::PiezoPulses pulses(double amplitude, double rise_time, double rate, unsigned number) {
  cell_microinjection::PiezoPulses message;
  message.amplitude = amplitude;
  message.rise_time = rise_time;
  message.rate = rate;
  message.number = number;
  return message;
}

class PiezoTrainTest : public testing::Test {
 protected:
  PiezoTrainTest() {
    punctured();
    session_.add("cell_simulator", "{needle: measured, diagnostic_period: 0.1}");
    session_.run(0.05);
    needle_.moveTo(25e-6, 100e-6);  // 3 um deep, far from the 7.5 uN of its puncture
    EXPECT_FALSE(punctured());
  }
  bool punctured() {
    const auto* state = session_.world().hear<cell_microinjection::CellState>("cell/state").newest();
    return state && state->punctured;
  }
  void send(const cell_microinjection::PiezoPulses& message) {
    session_.world().sayNow("needle/piezo_pulses", message);
    session_.run(0.1);
  }

  VirtualSession session_{{"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live"}};
  ScriptedNeedle needle_{session_, 31e-6};
};

TEST_F(PiezoTrainTest, AStrongPulseBreaksTheMembraneAndAWeakOneDoesNot) {
  send(pulses(0.5e-6, 0.5e-3, 50, 20));
  EXPECT_FALSE(punctured());
  send(pulses(10e-6, 5e-6, 50, 1));
  EXPECT_TRUE(punctured());
}

TEST_F(PiezoTrainTest, TheirNumberAndRateCount) {
  for (const unsigned number : {2u, 3u}) {
    needle_.moveTo(31e-6, 100e-6);
    send(pulses(10e-6, 5e-6, 10, number));  // the third is 0.2 s after the first
    needle_.moveTo(25e-6, 1e-3);
    session_.run(0.3);
    EXPECT_EQ(punctured(), number == 3) << number;
  }
}

TEST_F(PiezoTrainTest, ANumberOfZeroEndsThem) {
  needle_.moveTo(31e-6, 100e-6);
  send(pulses(10e-6, 5e-6, 10, 1000));
  send(pulses(0, 0, 0, 0));
  needle_.moveTo(25e-6, 100e-6);
  session_.run(0.2);
  EXPECT_FALSE(punctured());
}

/// A stop must not be late because a clock is wrong.
TEST_F(PiezoTrainTest, AStopCountsWhateverItsStamp) {
  needle_.moveTo(31e-6, 100e-6);
  send(pulses(10e-6, 5e-6, 10, 1000));
  auto stop = pulses(0, 0, 0, 0);
  stop.header.stamp = session_.now() + ros::Duration(1000);
  session_.world().say("needle/piezo_pulses", stop);
  session_.run(0.1);
  needle_.moveTo(25e-6, 100e-6);
  session_.run(0.2);
  EXPECT_FALSE(punctured());
}

TEST_F(PiezoTrainTest, WhatNoPiezoDoesIsRefused) {
  for (const auto& wrong :
       {pulses(30e-6, 5e-6, 10, 1), pulses(-1e-6, 5e-6, 10, 1), pulses(NAN, 5e-6, 10, 1), pulses(10e-6, 0, 10, 1),
        pulses(10e-6, 1e-3, 10, 1), pulses(10e-6, 5e-6, 0, 1), pulses(10e-6, 5e-6, INFINITY, 1),
        pulses(10e-6, 5e-6, 10, 1001), pulses(10e-6, 0.5e-3, 1000.1, 1)}) {
    send(wrong);
    EXPECT_FALSE(punctured()) << wrong;
  }
  for (const double age : {-0.7, 0.7}) {
    auto late = pulses(10e-6, 5e-6, 10, 1);
    late.header.stamp = session_.now() - ros::Duration(age);
    session_.world().say("needle/piezo_pulses", late);
    session_.run(0.1);
    EXPECT_FALSE(punctured()) << age;
  }
  session_.world().say("needle/piezo_pulses", pulses(10e-6, 5e-6, 10, 1));  // without a stamp
  session_.run(0.1);
  EXPECT_FALSE(punctured());
  send(pulses(10e-6, 5e-6, 10, 1));
  EXPECT_TRUE(punctured()) << "which any of them would have done";
}

}  // namespace
}  // namespace microinjection
