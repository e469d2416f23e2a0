#include <gtest/gtest.h>
#include <unistd.h>

#include <optional>
#include <string>

#include "hardware/serial/pseudo_terminal.h"
#include "nodes/needle/force_sources.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

/// A sensor on a line whose other end the test has. The time that the source reads is the test's.
class SerialForceSourceTest : public testing::Test {
 protected:
  static constexpr double kTimeout = 0.05;  // s

  SerialForceSourceTest() : line_(path_) {
    VoltReadingConfig reading;
    reading.separator = "\t";
    reading.columns = reading.voltages = 2;
    reading.matrix = Eigen::Matrix2d::Identity();
    reading.offset = Eigen::Vector2d::Zero();
    SerialPortConfig port;
    port.path = path_;
    source_.emplace(port, reading, Eigen::Vector2d(10, 10), kTimeout, "force_sensor");
  }
  bool reads(double seconds) {
    now_ += durationOf(seconds);
    return source_->read({now_, seconds}).has_value();
  }
  bool saysUntilItReads() {
    for (int i = 0; i < 1000; ++i) {
      line_.write("1.0\t0.5\n");
      usleep(1000);
      if (reads(1e-3)) return true;
    }
    return false;
  }

  UserFolders folders_;
  const std::string path_ = folders_.path() / "sensor";
  PseudoTerminal line_;
  std::optional<SerialForceSource> source_;
  ros::Time now_{100.0};
};

TEST_F(SerialForceSourceTest, ASensorThatFallsSilentIsInvalid) {
  ASSERT_TRUE(saysUntilItReads());
  EXPECT_EQ(source_->invalidReason(), "");
  EXPECT_FALSE(reads(0.5 * kTimeout));
  EXPECT_EQ(source_->invalidReason(), "");
  EXPECT_FALSE(reads(kTimeout));
  EXPECT_EQ(source_->invalidReason(), "no good line from the sensor");
  EXPECT_TRUE(saysUntilItReads());
  EXPECT_EQ(source_->invalidReason(), "");
}

}  // namespace
}  // namespace microinjection
