#include "base/console_relay.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

namespace microinjection {
namespace {

constexpr int kPatience = 60000;  // ms; only what hangs takes that long

/// A program of its own with standard output and error on a pseudo-terminal, which tells on a pipe how far it is.
class Program {
 public:
  explicit Program(const std::function<void(const Program&)>& run) {
    master_ = posix_openpt(O_RDWR | O_NOCTTY);
    grantpt(master_);
    unlockpt(master_);
    slave_ = open(ptsname(master_), O_RDWR | O_NOCTTY);
    termios mode{};
    tcgetattr(slave_, &mode);
    cfmakeraw(&mode);
    tcsetattr(slave_, TCSANOW, &mode);
    EXPECT_EQ(pipe(progress_.data()), 0);
    EXPECT_EQ(pipe(orders_.data()), 0);
    child_ = fork();
    if (child_ != 0) return;
    dup2(slave_, STDOUT_FILENO);
    dup2(slave_, STDERR_FILENO);
    run(*this);
    _exit(0);
  }
  ~Program() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    for (const int each : {master_, slave_, progress_[0], progress_[1], orders_[0], orders_[1]}) close(each);
  }

  void stopTerminal() const { tcflow(slave_, TCOOFF); }
  void resumeTerminal() const { tcflow(slave_, TCOON); }

  // In the program.
  void say(char step) const { EXPECT_EQ(write(progress_[1], &step, 1), 1); }
  /// Returns whether it came. `patience`: ms; -1: without end.
  bool awaitOrder(int patience = -1) const {
    pollfd input{orders_[0], POLLIN, 0};
    char order;
    return poll(&input, 1, patience) > 0 && read(orders_[0], &order, 1) == 1;
  }

  // In the test.
  void order() const { EXPECT_EQ(write(orders_[1], "x", 1), 1); }
  /// The next step that the program says; 0 when it hangs.
  char next() const {
    pollfd input{progress_[0], POLLIN, 0};
    char step = 0;
    if (poll(&input, 1, kPatience) <= 0 || read(progress_[0], &step, 1) != 1) return 0;
    return step;
  }
  /// The next `size` bytes on the terminal; fewer when it hangs.
  std::string output(std::size_t size) const {
    std::string text(size, '\0');
    std::size_t done = 0;
    pollfd input{master_, POLLIN, 0};
    while (done < size && poll(&input, 1, kPatience) > 0) {
      const ssize_t count = read(master_, &text[done], size - done);
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    return text.substr(0, done);
  }
  /// All that is on the terminal up to and with `last`.
  std::string outputUntil(const std::string& last) const {
    std::string text;
    std::array<char, 4096> buffer;
    pollfd input{master_, POLLIN, 0};
    while (text.find(last) == std::string::npos && poll(&input, 1, kPatience) > 0) {
      const ssize_t size = read(master_, buffer.data(), buffer.size());
      if (size <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return text;
  }

 private:
  int master_ = -1, slave_ = -1;
  pid_t child_ = -1;
  std::array<int, 2> progress_{}, orders_{};
};

/// Returns whether the machine let the relay end in time. Else the rest comes behind what is written next, or around
/// it.
bool passesOnInTime() {
  const std::string end = "end\n";
  const Program program([](const Program& self) {
    std::chrono::steady_clock::time_point ends;
    {
      const ConsoleRelay relay;
      for (int i = 0; i < 1000; ++i) {
        std::printf("out %d\n", i);
        std::fprintf(stderr, "err %d\n", i);
      }
      ends = std::chrono::steady_clock::now();
    }
    // It waits for 0.5 s at the most.
    self.say(std::chrono::steady_clock::now() - ends < std::chrono::milliseconds(450) ? 'i' : 'l');
    std::printf("end\n");
    std::fflush(stdout);
    EXPECT_TRUE(self.awaitOrder());
  });
  std::string expected;
  for (int i = 0; i < 1000; ++i) expected += "out " + std::to_string(i) + "\nerr " + std::to_string(i) + "\n";
  std::string text = program.output(expected.size() + end.size());
  const std::size_t at = text.find(end);
  const char step = program.next();
  EXPECT_NE(step, 0) << "the program hangs";
  if (step == 'i') {
    EXPECT_EQ(at, expected.size());
  }
  if (at != std::string::npos) text.erase(at, end.size());
  EXPECT_EQ(text, expected);
  return step == 'i';
}

TEST(ConsoleRelay, PassesOnWhatIsWrittenInItsOrder) {
  bool in_time = false;
  for (int run = 0; run < 5 && !in_time && !HasFailure(); ++run) in_time = passesOnInTime();
  EXPECT_TRUE(in_time) << "the relay never ended within 0.45 s";
}

TEST(ConsoleRelay, StoppedTerminalHoldsNobodyUpAndWhatIsMissingIsCounted) {
  constexpr int kLines = 100000;  // more than pipe and relay hold
  const Program program([](const Program& self) {
    self.stopTerminal();
    const ConsoleRelay relay;
    // Twice, and each time until the reading thread has taken it: while that gets no processor time, the pipe is full
    // and no line reaches it that it could count.
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i < kLines; ++i) std::printf("a line of the loop, number %d\n", i);
      for (int waiting = 1; waiting > 0 && ioctl(STDOUT_FILENO, FIONREAD, &waiting) == 0;) usleep(1000);
    }
    self.say('w');
    // Until the terminal has taken some of what waits, there is no room for it.
    while (!self.awaitOrder(10)) std::printf("resumed\n");
  });
  ASSERT_EQ(program.next(), 'w') << "the program waits for its terminal";
  program.resumeTerminal();
  program.outputUntil("number 100\n");
  const std::string rest = program.outputUntil("resumed\n");
  EXPECT_NE(rest.find(" lines of output are missing here"), std::string::npos);
  program.order();
}

TEST(ConsoleRelay, EndsAlthoughTheTerminalIsStopped) {
  const Program program([](const Program& self) {
    self.stopTerminal();
    {
      const ConsoleRelay relay;
      std::printf("never seen\n");
    }
    self.say('e');
    EXPECT_TRUE(self.awaitOrder());
  });
  EXPECT_EQ(program.next(), 'e');
}

TEST(ConsoleRelay, WhatACrashSaysIsNotLost) {
  const Program program([](const Program&) {
    const ConsoleRelay relay;
    std::terminate();
  });
  EXPECT_NE(program.outputUntil("terminate called").find("terminate called"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
