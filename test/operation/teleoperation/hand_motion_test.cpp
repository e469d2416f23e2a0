#include "operation/teleoperation/hand_motion.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string fileWith(const std::string& text) {
  const std::string path = testing::TempDir() + "hand_motion_test.csv";
  std::ofstream(path) << text;
  return path;
}

std::string complaintAbout(const std::string& text) {
  try {
    HandMotion::load(fileWith(text));
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

TEST(HandMotion, TheOneThatIsShippedLoads) {
  const HandMotion motion =
      HandMotion::load(std::string(MICROINJECTION_SOURCE_DIR) + "/config/hand_motions/indent_and_retract.csv");
  EXPECT_EQ(motion.at(0).phase, "approach");
  bool clutched = false;
  for (double t = 0; t < motion.duration(); t += 0.01) clutched = clutched || motion.at(t).clutch;
  EXPECT_TRUE(clutched);
}

}  // namespace
}  // namespace microinjection
