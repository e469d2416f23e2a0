#include "hardware/serial/serial_port.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "hardware/serial/pseudo_terminal.h"

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
  bool terminalReadsLast(PseudoTerminal& terminal, const std::string& end) {
    heard_.clear();
    return eventually([&] {
      heard_ += terminal.read();
      return heard_.size() >= end.size() && heard_.compare(heard_.size() - end.size(), end.size(), end) == 0;
    });
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

TEST_F(SerialPortTest, AsksForTheHandshakeOfItsConfiguration) {
  PseudoTerminal terminal(link_);
  for (const char* handshake : {"none", "rts_cts"}) {
    SerialPortConfig config;
    config.path = link_;
    config.handshake = handshake;
    SerialPort port(config);
    ASSERT_EQ(port.open(), "");
    const int other = ::open(link_.c_str(), O_RDWR | O_NOCTTY);
    termios settings{};
    ASSERT_EQ(tcgetattr(other, &settings), 0);
    EXPECT_EQ((settings.c_cflag & CRTSCTS) != 0, config.handshake == "rts_cts");
    ::close(other);
  }
  const auto read = [](const std::string& text) {
    ConfigReader reader(YAML::Load(text), "port.yaml");
    const SerialPortConfig config = SerialPortConfig::read(reader, 9600);
    reader.finish();
    return config.handshake;
  };
  EXPECT_EQ(read("{path: /dev/x}"), "none");
  EXPECT_EQ(read("{path: /dev/x, handshake: rts_cts}"), "rts_cts");
  EXPECT_THROW(read("{path: /dev/x, handshake: dtr}"), ConfigError);
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
  terminal.disconnect();
  EXPECT_TRUE(eventually([&] { return port_.read(0), !port_.isOpen(); }));
  EXPECT_NE(port_.open(), "");
  terminal.connect();
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
    const int line = ::open(link_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
    pollfd there{line, POLLIN, 0};
    EXPECT_EQ(poll(&there, 1, 5000), 1);  // the kernel has handed it over before the next one opens
    ::close(line);
  }
  ASSERT_EQ(port_.open(), "");
  terminal.write("second");
  EXPECT_TRUE(portReads("second"));  // what came before it opened is not its own
}

/// A program of its own that says "go on" and ends: killed, or in good order. Returns whether the machine held it up
/// for so long that its guard may have stopped the device before.
bool runDriver(const SerialPortConfig& config, int signal) {
  const auto begin = std::chrono::steady_clock::now();
  const pid_t driver = fork();
  if (driver == 0) {
    {
      SerialPort port(config);
      port.setGuardedStop("stop");
      if (!port.open().empty()) _exit(1);
      port.write("go on, ", 0);
      if (signal != 0) {
        std::signal(signal, SIG_DFL);  // a sanitizer would report a fault and end in its own way
        raise(signal);
      }
    }
    _exit(0);
  }
  int status = 0;
  waitpid(driver, &status, 0);
  EXPECT_EQ(signal != 0 ? WTERMSIG(status) : WEXITSTATUS(status), signal);
  return std::chrono::steady_clock::now() - begin > std::chrono::milliseconds(150);
}

TEST_F(SerialPortTest, AKilledDriversStopIsSaid) {
  for (const int signal : {SIGKILL, SIGTERM, SIGSEGV}) {
    PseudoTerminal terminal(link_);
    const bool held_up = runDriver({link_, 9600}, signal);
    if (held_up) {
      EXPECT_TRUE(terminalReadsLast(terminal, "stop")) << heard_;
    } else {
      EXPECT_TRUE(terminalReads(terminal, "go on, stop")) << heard_;
    }
    SerialPort next({link_, 9600});
    EXPECT_TRUE(eventually([&] { return next.open().empty(); }));  // and the line is free again
  }
}

TEST_F(SerialPortTest, ReadsParityAndStopBits) {
  const auto read = [](const std::string& text) {
    ConfigReader reader(YAML::Load(text), "test.yaml");
    const auto config = SerialPortConfig::read(reader, 9600);
    reader.finish();
    return config;
  };
  EXPECT_EQ(read("{path: /dev/ttyUSB0}").frame(), "8N1");
  EXPECT_EQ(read("{path: /dev/ttyUSB0, stop_bits: 2}").frame(), "8N2");
  EXPECT_EQ(read("{path: /dev/ttyUSB0, parity: even}").frame(), "8E1");
  EXPECT_EQ(read("{path: /dev/ttyUSB0, parity: odd, stop_bits: 2}").frame(), "8O2");
  for (const auto& [wrong, why] :
       {std::pair("stop_bits: 3", "stop_bits"), {"stop_bits: 1.5", "stop_bits"}, {"parity: mark", "none, even, odd"}}) {
    try {
      read(std::string("{path: /dev/ttyUSB0, ") + wrong + "}");
      ADD_FAILURE() << wrong;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }
}

TEST_F(SerialPortTest, SetsStopBitsOnTheLine) {
  PseudoTerminal terminal(link_);
  for (const int stop_bits : {1, 2}) {
    SerialPort port({link_, 9600, "none", stop_bits});
    ASSERT_EQ(port.open(), "");
    const int line = open(link_.c_str(), O_RDWR | O_NOCTTY);
    termios settings{};
    ASSERT_EQ(tcgetattr(line, &settings), 0);
    close(line);
    EXPECT_EQ((settings.c_cflag & CSTOPB) != 0, stop_bits == 2);
  }
}

TEST_F(SerialPortTest, SetsParityOnTheLineOrSaysThatItCannot) {
  PseudoTerminal terminal(link_);
  SerialPort port({link_, 9600, "odd", 1});
  const std::string why = port.open();  // a pseudo-terminal has no parity bit, and some C libraries tell
  if (!why.empty()) {
    EXPECT_NE(why.find("9600 baud, 8O1"), std::string::npos) << why;
    return;
  }
  const int line = open(link_.c_str(), O_RDWR | O_NOCTTY);
  termios settings{};
  ASSERT_EQ(tcgetattr(line, &settings), 0);
  close(line);
  EXPECT_NE(settings.c_cflag & PARODD, 0u);
}

TEST_F(SerialPortTest, TheGuardKeepsNothingElseOpen) {
  PseudoTerminal terminal(link_);
  std::vector<std::array<int, 2>> pipes(150);  // more than are listed at a time
  for (auto& ends : pipes) ASSERT_EQ(pipe(ends.data()), 0);
  port_.setGuardedStop("stop");
  ASSERT_EQ(port_.open(), "");
  for (const auto& ends : pipes) {
    close(ends[1]);
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
  }
  char byte = 0;
  for (const auto& ends : pipes) {
    ASSERT_TRUE(eventually([&] { return read(ends[0], &byte, 1) == 0; }));  // its end is seen: nobody holds it open
    close(ends[0]);
  }
  EXPECT_TRUE(port_.isOpen());
}

TEST_F(SerialPortTest, ADriverThatClosesItsLineIsNotSpokenFor) {
  PseudoTerminal terminal(link_);
  const bool held_up = runDriver({link_, 9600}, 0);
  ASSERT_TRUE(eventually([&] { return port_.open().empty(); }));  // a guard that is held up ends later
  port_.write("next", 0);
  if (held_up) {
    EXPECT_TRUE(terminalReadsLast(terminal, "next")) << heard_;
  } else {
    EXPECT_TRUE(terminalReads(terminal, "go on, next")) << heard_;
  }
}

TEST_F(SerialPortTest, TheTerminalTakesItsLinkAway) {
  { PseudoTerminal terminal(link_); }
  EXPECT_FALSE(std::filesystem::is_symlink(link_));
}

}  // namespace
}  // namespace microinjection
