#include "hardware/serial/line_mode.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <string>

#include "hardware/serial/pseudo_terminal.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {
namespace {

/// A driver's port as the two calls show it.
struct FakeDriver {
  serial_struct port{};
  bool takes = true;  // the flag
  int written = 0;

  int control(unsigned long request, void* argument) {
    auto& asked = *static_cast<serial_struct*>(argument);
    if (request == TIOCGSERIAL) {
      asked = port;
      return 0;
    }
    if (request != TIOCSSERIAL || !takes) return -1;
    ++written;
    port = asked;
    return 0;
  }
  bool request() {
    return requestLowLatency(7, [this](int fd, unsigned long request, void* argument) {
      EXPECT_EQ(fd, 7);
      return control(request, argument);
    });
  }
};

TEST(LowLatency, SetsTheFlagAndNothingElse) {
  FakeDriver driver;
  driver.port.flags = ASYNC_SPD_HI;
  driver.port.close_delay = 50;
  EXPECT_TRUE(driver.request());
  EXPECT_EQ(driver.port.flags, ASYNC_SPD_HI | ASYNC_LOW_LATENCY);
  EXPECT_EQ(driver.port.close_delay, 50);
  EXPECT_TRUE(driver.request());
  EXPECT_EQ(driver.written, 1);  // it is set already
}

TEST(LowLatency, ADriverWithoutItIsLeftAsItIs) {
  FakeDriver driver;
  driver.takes = false;
  EXPECT_FALSE(driver.request());
  EXPECT_EQ(driver.port.flags, 0);
}

TEST(LowLatency, APseudoTerminalHasNoneAndIsOpenedAllTheSame) {
  const std::string link = testing::TempDir() + "low_latency_test_" + std::to_string(getpid());
  PseudoTerminal terminal(link);
  const int fd = ::open(link.c_str(), O_RDWR | O_NOCTTY);
  ASSERT_GE(fd, 0);
  EXPECT_FALSE(requestLowLatency(fd));
  ::close(fd);
  SerialPort port({link, 9600});
  EXPECT_EQ(port.open(), "");
}

}  // namespace
}  // namespace microinjection
