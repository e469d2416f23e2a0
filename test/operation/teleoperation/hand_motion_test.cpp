#include "operation/teleoperation/hand_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string fileWith(const std::string& text, const std::string& ending = ".csv") {
  const std::string path = testing::TempDir() + "hand_motion_test" + ending;
  std::ofstream(path) << text;
  return path;
}

std::string complaintAbout(const std::string& text, const std::string& ending = ".csv") {
  try {
    HandMotion::load(fileWith(text, ending));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

constexpr char kHeader[] = "time_s,x_m,y_m,z_m,clutch,phase\n";

TEST(HandMotion, InterpolatesPositionAndHoldsTheRest) {
  const HandMotion motion = HandMotion::load(fileWith(
      std::string("# comment\n") + kHeader + "0,0,0,0,0,approach\n1,0.1,0,-0.2,1,touch\n2,0.1,0,-0.2,0,hold\n"));
  EXPECT_DOUBLE_EQ(motion.duration(), 2);
  const HandMotion::Sample half = motion.at(0.5);
  EXPECT_LT((half.position - Eigen::Vector3d(0.05, 0, -0.1)).norm(), 1e-15);
  EXPECT_EQ(half.phase, "approach");
  EXPECT_FALSE(half.clutch);
  EXPECT_TRUE(motion.at(1.0).clutch);
  EXPECT_EQ(motion.at(-1).phase, "approach");
  EXPECT_EQ(motion.at(99).phase, "hold");
  EXPECT_DOUBLE_EQ(motion.at(99).position.z(), -0.2);
}

TEST(HandMotion, NamesFileLineAndValueOfWhatIsWrong) {
  EXPECT_NE(complaintAbout("t,x\n").find(".csv:1: header must be time_s"), std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "0,0,0,zero,0,a\n").find(".csv:2: \"zero\""), std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "0,0,0,nan,0,a\n").find("\"nan\""), std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "0,0,0,0,2,a\n").find("clutch = 2"), std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "0,0,0,0,0\n").find("six cells"), std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "1,0,0,0,0,a\n1,0,0,0,0,a\n").find("must be later"),
            std::string::npos);
  EXPECT_NE(complaintAbout(std::string(kHeader) + "1,0,0,0,0,a\n").find("two samples"), std::string::npos);
  EXPECT_THROW(HandMotion::load("/nowhere/motion.csv"), ConfigError);
}

TEST(GeneratedMotion, GoesThroughItsWaypointsWithMinimumJerk) {
  const HandMotion motion =
      HandMotion::load(fileWith("path:\n"
                                "  - {phase: approach, duration: 2, z: -0.01}\n"
                                "  - {phase: back, duration: 1, z: 0.01, clutch: true}\n",
                                ".yaml"));
  EXPECT_DOUBLE_EQ(motion.duration(), 3);
  EXPECT_NEAR(motion.at(1).position.z(), -0.005, 1e-12);
  EXPECT_NEAR(motion.at(2).position.z(), -0.01, 1e-12);
  EXPECT_EQ(motion.at(2.5).phase, "back");
  EXPECT_TRUE(motion.at(2.5).clutch);
  EXPECT_FALSE(motion.at(1.5).clutch);
  // Largest speed and acceleration of a path of minimum jerk over distance d in time T: 15/8 d/T, 10/sqrt(3) d/T^2.
  double speed = 0, acceleration = 0;
  for (double t = 0.005; t < 1.99; t += 0.005) {
    const double before = motion.at(t - 0.005).position.z(), z = motion.at(t).position.z();
    speed = std::max(speed, std::abs(z - before) / 0.005);
    acceleration = std::max(acceleration, std::abs(motion.at(t + 0.005).position.z() - 2 * z + before) / 25e-6);
  }
  EXPECT_NEAR(speed, 15.0 / 8 * 0.01 / 2, 1e-5);
  EXPECT_NEAR(acceleration, 10 / std::sqrt(3.0) * 0.01 / 4, 1e-4);
}

TEST(GeneratedMotion, TremorHasItsSizeAndItsBandAndFadesAtTheEnds) {
  const auto tremor = [](int seed) {
    return HandMotion::load(fileWith(
        "tremor: {rms: 1.0e-4, seed: " + std::to_string(seed) + "}\npath: [{phase: rest, duration: 60, z: 0}]\n",
        ".yaml"));
  };
  const HandMotion motion = tremor(3);
  EXPECT_EQ(motion.at(0).position, Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(motion.at(60).position, Eigen::Vector3d::Zero().eval());
  Eigen::Array3d squares = Eigen::Array3d::Zero(), crossings = Eigen::Array3d::Zero();
  for (int i = 200; i < 11800; ++i) {
    const Eigen::Array3d before = motion.at((i - 1) / 200.0).position, now = motion.at(i / 200.0).position;
    squares += now.square() / 11600;
    crossings += (before * now < 0).cast<double>();
  }
  EXPECT_TRUE(((squares.sqrt() - 1e-4).abs() < 1e-5).all()) << squares.sqrt().transpose();
  EXPECT_TRUE((crossings / 58 / 2 > 8).all() && (crossings / 58 / 2 < 12).all()) << crossings.transpose();
  EXPECT_EQ(motion.at(7.1).position, tremor(3).at(7.1).position);
  EXPECT_NE(motion.at(7.1).position, tremor(4).at(7.1).position);
}

TEST(GeneratedMotion, NamesFileAndKeyOfWhatIsWrong) {
  EXPECT_NE(complaintAbout("tremor: {rms: 1}\n", ".yaml").find("path"), std::string::npos);
  EXPECT_NE(complaintAbout("path: []\n", ".yaml").find("must have a waypoint"), std::string::npos);
  EXPECT_NE(complaintAbout("path: [{phase: a, duration: 0, z: 0}]\n", ".yaml").find("path/0/duration = 0"),
            std::string::npos);
  EXPECT_NE(complaintAbout("path: [{phase: a, duration: 1, z: 0, jerk: 1}]\n", ".yaml").find("jerk"),
            std::string::npos);
}

TEST(HandMotion, TheOneThatIsShippedLoads) {
  const HandMotion motion =
      HandMotion::load(std::string(MICROINJECTION_SOURCE_DIR) + "/config/hand_motions/indent_and_retract.yaml");
  EXPECT_EQ(motion.at(0).phase, "approach");
  bool clutched = false;
  for (double t = 0; t < motion.duration(); t += 0.01) clutched = clutched || motion.at(t).clutch;
  EXPECT_TRUE(clutched);
}

}  // namespace
}  // namespace microinjection
