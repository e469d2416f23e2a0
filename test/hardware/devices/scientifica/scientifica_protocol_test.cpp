#include "hardware/devices/scientifica/scientifica_protocol.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(ScientificaProtocol, CountsAsTheCardsVersionDoes) {
  EXPECT_DOUBLE_EQ(scientificaCount(2), 0.1e-6);
  EXPECT_DOUBLE_EQ(scientificaCount(3), 0.01e-6);
  EXPECT_DOUBLE_EQ(scientificaScale(2), 6.4);
  EXPECT_DOUBLE_EQ(scientificaScale(3), 1600);
  EXPECT_EQ(scientificaRequestScale(2, 1), "UUY");
  EXPECT_EQ(scientificaRequestScale(3, 2), "USTEP Z");
}

/// As the card's command list is quoted by ScanImage: TOP is um/s * 2 * UU, ACC is um/s^2 * UU / 250.
TEST(ScientificaProtocol, SetsSpeedAndAccelerationInTheCardsUnits) {
  EXPECT_EQ(scientificaTop(2, 1e-3), 12800);
  EXPECT_EQ(scientificaTop(3, 1e-3), 1000);
  EXPECT_DOUBLE_EQ(scientificaSpeed(2, 12800), 1e-3);
  EXPECT_EQ(scientificaTop(2, 1e-6), 1000);
  EXPECT_EQ(scientificaTop(2, 1), 50000);
  EXPECT_NEAR(scientificaSlowest(2), 78.125e-6, 1e-12);
  EXPECT_EQ(scientificaAcceleration(2, 0.01953125), 500);
  EXPECT_EQ(scientificaAcceleration(2, 1), 1000);
  EXPECT_EQ(scientificaAcceleration(3, 0.03), 30000);
}

TEST(ScientificaProtocol, ReadsPositionsMotionAndNumbers) {
  EXPECT_EQ(*readScientificaPosition("1321\t543\t-2"), Eigen::Vector3d(1321, 543, -2));
  for (const char* answer : {"", "A", "E", "1321\t543", "1321\t543\t2\t4", "1321 543 2", "1321\t54.3\t2", "1\t2\t1e3",
                             "1234567890\t0\t0", "1\t2\t3 "}) {
    EXPECT_FALSE(readScientificaPosition(answer)) << answer;
  }
  EXPECT_FALSE(*readScientificaMotion("0"));
  for (const char* answer : {"1", "4", "7"}) EXPECT_TRUE(*readScientificaMotion(answer));
  for (const char* answer : {"", "8", "00", "A", " 0"}) EXPECT_FALSE(readScientificaMotion(answer)) << answer;
  EXPECT_DOUBLE_EQ(*readScientificaNumber("-6.40"), -6.4);
  for (const char* answer : {"", "E,3", "6.4.1", "1e3", "nan", "A"})
    EXPECT_FALSE(readScientificaNumber(answer)) << answer;
}

TEST(ScientificaProtocol, SaysAGoTo) { EXPECT_EQ(scientificaGoTo({100, -26, 3}), "ABS 100 -26 3"); }

}  // namespace
}  // namespace microinjection
