#include "operation/control/training_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace microinjection {
namespace {

TrainingTask task() {
  TrainingTask task;
  task.peak_force = 2e-6;
  task.deformation = 20e-6;
  task.lateral_error = 2e-6;
  task.time = 8;
  task.volume = 10e-15;
  return task;
}

TraineeSample at(double time, InjectionState state, double depth, double force, double x = 0) {
  TraineeSample sample;
  sample.time = time;
  sample.state = state;
  sample.tip = {x, 0, 28e-6 - depth};
  sample.force = {0, 0, force};
  if (depth > 0) sample.depth = depth;
  return sample;
}

/// 1 uN, 15 um, 1 um aside, 7 s.
TrainingSession goodSession(double volume = 10e-15, int punctures = 1) {
  TrainingSession session;
  session.add(at(0, InjectionState::kIdle, -10e-6, 0));
  session.add(at(0.5, InjectionState::kApproach, -10e-6, 0));
  session.add(at(1, InjectionState::kApproach, -10.5e-6, 0));  // trembles, and does not set out
  session.add(at(3, InjectionState::kIndent, 1e-6, 0.1e-6, 5e-6));
  session.add(at(4, InjectionState::kIndent, 15e-6, -1e-6, 6e-6));
  TraineeSample through = at(5, InjectionState::kPunctured, 18e-6, 0.3e-6, 6e-6);
  through.punctures = punctures;
  session.add(through);
  through.time = 6;
  through.volume = volume;
  session.add(through);
  through.time = 8;
  through.volume = volume + 7e-15;  // leaks on the way out
  through.state = InjectionState::kWithdraw;
  through.tip.x() = 1;
  session.add(through);
  through.time = 100;
  through.depth.reset();
  through.volume += 50e-15;
  through.punctures = 0;
  through.state = InjectionState::kIdle;
  session.add(through);
  return session;
}

TEST(TrainingScore, MeasuresASession) {
  const TrainingScore score = goodSession().score(task());
  EXPECT_DOUBLE_EQ(score.peak_force, 1e-6);
  EXPECT_DOUBLE_EQ(score.deformation, 15e-6) << "what is deeper after the puncture is no deformation";
  EXPECT_NEAR(score.lateral_error, 1e-6, 1e-15) << "on the way out it is not counted";
  EXPECT_DOUBLE_EQ(score.time, 7);
  EXPECT_EQ(score.punctures, 1);
  EXPECT_DOUBLE_EQ(score.volume, 10e-15) << "what leaves the tip outside of the cell is not injected";
  EXPECT_EQ(score.outcome, TrainingOutcome::kComplete) << score.reason;
  EXPECT_DOUBLE_EQ(score.score(), 100);
}

TEST(TrainingScore, PointsAreLostInProportion) {
  TrainingTask hard = task();
  hard.peak_force = 0.8e-6;     // exceeded by a fourth
  hard.deformation = 10e-6;     // by a half
  hard.lateral_error = 0.5e-6;  // twice
  hard.time = 5.6;              // by a fourth
  hard.punctures = 2;           // half
  hard.volume = 8e-15;          // by a fourth
  const TrainingScore score = goodSession().score(hard);
  const auto& [force, deformation, lateral, time, punctures, volume] = score.points;
  EXPECT_NEAR(force, 0.75 * 25, 1e-9);
  EXPECT_NEAR(deformation, 0.5 * 15, 1e-9);
  EXPECT_NEAR(lateral, 0, 1e-6);
  EXPECT_NEAR(time, 0.75 * 10, 1e-9);
  EXPECT_NEAR(punctures, 0.5 * 20, 1e-9);
  EXPECT_NEAR(volume, 0.75 * 10, 1e-9);
  EXPECT_NEAR(score.score(), 18.75 + 7.5 + 7.5 + 10 + 7.5, 1e-6);
  double most = 0;
  for (const TrainingMeasure& measure : score.measures(hard)) most += measure.most;
  EXPECT_DOUBLE_EQ(most, 100);
}

TEST(TrainingScore, NothingDoneIsNothing) {
  EXPECT_EQ(TrainingSession().score(task()).score(), 0);
  TrainingSession idle;
  idle.add(at(0, InjectionState::kIdle, -1e-6, 0));
  EXPECT_EQ(idle.score(task()).score(), 0);
  idle.add(at(1, InjectionState::kApproach, -1e-6, 0));
  idle.add(at(2, InjectionState::kIdle, -3e-6, 0));
  EXPECT_EQ(idle.score(task()).outcome, TrainingOutcome::kUntouched);
  EXPECT_EQ(idle.score(task()).score(), 0) << "who does nothing does nothing wrong, but earns nothing either";
  EXPECT_EQ(goodSession(0, 0).score(task()).points[4], 0);
  EXPECT_EQ(goodSession(0, 3).score(task()).points[4], 0);
}

/// Two moments in fifty are left out without harm, two in ten are not.
TEST(TrainingScore, WhatIsNotANumberIsLeftOutAndCounted) {
  for (const bool long_session : {true, false}) {
    TrainingSession session = goodSession();
    for (int i = 0; long_session && i < 40; ++i) session.add(at(200 + i, InjectionState::kIdle, -10e-6, 0));
    TraineeSample bad = at(300, InjectionState::kIndent, 15e-6, std::numeric_limits<double>::quiet_NaN());
    session.add(bad);
    bad = at(301, InjectionState::kIndent, 60e-6, 9e-6);
    bad.tip.x() = std::numeric_limits<double>::infinity();
    session.add(bad);
    const TrainingScore score = session.score(task());
    EXPECT_EQ(session.leftOut(), 2);
    EXPECT_DOUBLE_EQ(score.peak_force, 1e-6);
    EXPECT_DOUBLE_EQ(score.deformation, 15e-6);
    EXPECT_EQ(score.outcome, long_session ? TrainingOutcome::kComplete : TrainingOutcome::kInvalid);
    EXPECT_DOUBLE_EQ(score.score(), long_session ? 100 : 0);
    EXPECT_EQ(score.reason, long_session ? "" : "needle or force was not valid in 2 of 10 moments");
  }
}

TEST(TrainingScore, AnUnknownVolumeIsNoVolume) {
  TrainingSession session = goodSession(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(session.score(task()).volume, 0);
  EXPECT_EQ(session.score(task()).outcome, TrainingOutcome::kComplete);
}

TEST(TrainingScore, ASessionThatEndsInTheCellOrAtFaultIsAborted) {
  for (const auto& [state, reason] :
       {std::pair(InjectionState::kIndent, "it ended in indent"), {InjectionState::kFault, "the rig was at fault"}}) {
    TrainingSession session = goodSession();
    session.add(at(110, state, 5e-6, 0.5e-6));
    if (state == InjectionState::kFault) session.add(at(120, InjectionState::kIdle, -10e-6, 0));
    const TrainingScore score = session.score(task());
    EXPECT_EQ(score.outcome, TrainingOutcome::kAborted);
    EXPECT_EQ(score.reason, reason);
    EXPECT_EQ(score.score(), 0);
    EXPECT_DOUBLE_EQ(score.peak_force, 1e-6) << "it is measured all the same";
  }
}

TEST(TrainingScore, PuncturesOfSeveralCellsAddUp) {
  TrainingSession session;
  int time = 0;
  for (const int felt : {0, 1, 1, 2, 0, 0, 1, 0}) {
    TraineeSample sample = at(++time, InjectionState::kPunctured, 1e-6, 0);
    sample.punctures = felt;
    session.add(sample);
  }
  EXPECT_EQ(session.score(task()).punctures, 3);
}

/// A second touch elsewhere has its own line, and the way between them is no error.
TEST(TrainingScore, EachTouchHasItsLine) {
  TrainingSession session;
  session.add(at(1, InjectionState::kIndent, 1e-6, 0, 0));
  session.add(at(2, InjectionState::kIndent, 5e-6, 0, 0.4e-6));
  session.add(at(3, InjectionState::kApproach, -5e-6, 0, 9e-6));
  session.add(at(4, InjectionState::kIndent, 1e-6, 0, 9e-6));
  session.add(at(5, InjectionState::kIndent, 5e-6, 0, 9.1e-6));
  EXPECT_NEAR(session.score(task()).lateral_error, 0.4e-6, 1e-15);
}

class TrainingHistory : public testing::Test {
 protected:
  TrainingHistory() { std::filesystem::remove(path_); }
  ~TrainingHistory() override { std::filesystem::remove(path_); }
  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  const std::string path_ = testing::TempDir() + "training_history_test.csv";
};

TEST_F(TrainingHistory, RowsAreAppended) {
  const TrainingScore score = goodSession().score(task());
  appendTrainingRow(path_, "ada", "2026-01-01T10:00:00", score);
  appendTrainingRow(path_, "bob", "2026-01-02T10:00:00", score);
  const std::string text = content();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_NE(text.find("\nada,2026-01-01T10:00:00,complete,1e-06,1.5e-05,1e-06,7,1,1e-14,25,15,20,10,20,10,100\nbob,"),
            std::string::npos)
      << text;
}

TEST_F(TrainingHistory, NothingElseIsTouched) {
  EXPECT_THROW(appendTrainingRow(path_, "a,b", "now", {}), std::invalid_argument);
  EXPECT_THROW(appendTrainingRow(path_, "ada", "now\n", {}), std::invalid_argument);
  EXPECT_THROW(appendTrainingRow(path_, "", "now", {}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path_));
  std::ofstream(path_) << "my,own,table\n";
  EXPECT_THROW(appendTrainingRow(path_, "ada", "now", {}), std::runtime_error);
  EXPECT_EQ(content(), "my,own,table\n");
}

}  // namespace
}  // namespace microinjection
