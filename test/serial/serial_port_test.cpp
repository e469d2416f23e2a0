#include "serial/serial_port.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "base/errors.h"
#include "serial/pseudo_terminal.h"

namespace microinjection {
namespace {

/// The kernel hands bytes over when it likes: patience decides nothing but when to give up.
bool eventually(const std::function<bool()>& done) {
  for (int i = 0; i < 5000; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class SerialPortTest : public testing::Test {
 protected:
  const std::string link_ = testing::TempDir() + "serial_port_test_" + std::to_string(getpid());
  SerialPort port_{{link_, 9600}};
  std::string heard_;

  bool portReads(const std::string& bytes) {
    heard_.clear();
    return eventually([&] { return (heard_ += port_.read(0)) == bytes; });
  }
  bool terminalReads(PseudoTerminal& terminal, const std::string& bytes) {
    heard_.clear();
    return eventually([&] { return (heard_ += terminal.read()) == bytes; });
  }
};

std::string everyByte() {
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  return bytes;
}

TEST_F(SerialPortTest, CarriesEveryByteBothWays) {
  PseudoTerminal terminal(link_);
  ASSERT_EQ(port_.open(), "");
  port_.write(everyByte(), 0);
  EXPECT_TRUE(terminalReads(terminal, everyByte()));
  terminal.write(everyByte());
  EXPECT_TRUE(portReads(everyByte()));
  EXPECT_EQ(port_.read(0), "");  // and does not wait for more
}

TEST_F(SerialPortTest, SaysWhyItDoesNotOpen) {
  EXPECT_NE(port_.open().find(link_), std::string::npos);
  EXPECT_FALSE(port_.isOpen());
  std::ofstream(link_) << "no device";
  EXPECT_NE(port_.open(), "");
  EXPECT_FALSE(port_.isOpen());
  EXPECT_THROW(PseudoTerminal{link_}, ConfigError);  // and no emulator puts its link in a file's place
  std::filesystem::remove(link_);
}

TEST_F(SerialPortTest, NoticesAPulledCableAndOpensAgain) {
  PseudoTerminal terminal(link_);
  ASSERT_EQ(port_.open(), "");
  terminal.unplug();
  EXPECT_TRUE(eventually([&] { return port_.read(0), !port_.isOpen(); }));
  EXPECT_NE(port_.open(), "");
  terminal.plug();
  ASSERT_EQ(port_.open(), "");
  terminal.write("here again");
  EXPECT_TRUE(portReads("here again"));
}

TEST_F(SerialPortTest, ADriverMayGoAndAnotherComes) {
  PseudoTerminal terminal(link_);
  {
    SerialPort first({link_, 9600});
    ASSERT_EQ(first.open(), "");
    EXPECT_NE(port_.open().find("in use"), std::string::npos);
    terminal.write("for the first");
  }
  ASSERT_EQ(port_.open(), "");
  terminal.write("second");
  EXPECT_TRUE(portReads("second"));  // what came before it opened is not its own
}

/// A program of its own that says "go on" and ends: killed, or in good order.
void runDriver(const SerialPortConfig& config, int signal) {
  const pid_t driver = fork();
  if (driver == 0) {
    {
      SerialPort port(config);
      port.setStopWhenKilled("stop");
      if (!port.open().empty()) _exit(1);
      port.write("go on, ", 0);
      if (signal != 0) raise(signal);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(driver, &status, 0);
  ASSERT_EQ(signal != 0 ? WTERMSIG(status) : WEXITSTATUS(status), signal);
}

TEST_F(SerialPortTest, AKilledDriversStopIsSaid) {
  PseudoTerminal terminal(link_);
  for (const int signal : {SIGKILL, SIGTERM, SIGSEGV}) {
    runDriver({link_, 9600}, signal);
    EXPECT_TRUE(terminalReads(terminal, "go on, stop")) << heard_;
    SerialPort next({link_, 9600});
    EXPECT_TRUE(eventually([&] { return next.open().empty(); }));  // and the line is free again
  }
}

TEST_F(SerialPortTest, ADriverThatClosesItsLineIsNotSpokenFor) {
  PseudoTerminal terminal(link_);
  runDriver({link_, 9600}, 0);
  ASSERT_EQ(port_.open(), "");
  port_.write("next", 0);
  EXPECT_TRUE(terminalReads(terminal, "go on, next")) << heard_;
}

TEST_F(SerialPortTest, TheTerminalTakesItsLinkAway) {
  { PseudoTerminal terminal(link_); }
  EXPECT_FALSE(std::filesystem::is_symlink(link_));
}

}  // namespace
}  // namespace microinjection
