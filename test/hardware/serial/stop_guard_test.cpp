#include "hardware/serial/stop_guard.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <utility>

#include "hardware/serial/hold_ups.h"
#include "hardware/serial/pseudo_terminal.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {
namespace {

constexpr char kStop[] = "/stop\n";

void sleepFor(int duration) { std::this_thread::sleep_for(std::chrono::milliseconds(duration)); }

/// A guard that this program shows its steps, or does not. Steps of 1 ms are counted, not seconds: on a machine that
/// stands still the guard counts as few.
class StopGuardTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_GE(line_, 0);
    ASSERT_EQ(guard_.begin(line_, kStop), "");
    step();
    // Where the machine held this program up since the guard began, the guard was right.
    heard_.clear();
    interventions_.clear();
    hold_ups_ = HoldUps(guard_.process());
  }
  void TearDown() override {
    close(line_);
    endDriver();
  }
  void endDriver() {
    if (driver_ > 0) kill(driver_, SIGKILL);
    if (driver_ > 0) waitpid(driver_, nullptr, 0);
    driver_ = -1;
  }

  Wire::GuardReport step() {
    sleepFor(1);
    hold_ups_.note(guard_.process());
    Wire::GuardReport report = guard_.heartbeat();
    if (!report.intervention.empty()) interventions_ += report.intervention + ".";
    heard_ += terminal_.read();
    return report;
  }
  bool stepUntil(const std::function<bool()>& done) {
    for (int i = 0; i < 5000 && !done(); ++i) step();
    return done();
  }
  /// Shows no step.
  bool restUntil(const std::function<bool()>& done) {
    for (int i = 0; i < 5000 && !done(); ++i) {
      sleepFor(1);
      heard_ += terminal_.read();
    }
    hold_ups_.restart(guard_.process());
    return done();
  }
  bool hasStopped() const { return heard_.find(kStop) != std::string::npos; }
  /// Unless the machine let one of the two run and the other not, so that the one was right.
  void expectUndisturbed() {
    hold_ups_.note(guard_.process());
    if (hold_ups_.any()) return;
    EXPECT_EQ(interventions_, "");
    EXPECT_EQ(heard_, "");
  }
  /// To the guard, of which there must be one: -1 would be every process.
  void signalGuard(int signal) {
    ASSERT_GT(guard_.process(), 0);
    kill(guard_.process(), signal);
  }
  static bool lives(pid_t process) { return kill(process, 0) == 0; }

  const std::string link_ = testing::TempDir() + "stop_guard_test_" + std::to_string(getpid());
  PseudoTerminal terminal_{link_};
  int line_ = open(link_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  StopGuard guard_;
  pid_t driver_ = -1;  // a program of its own
  std::string heard_, interventions_;
  HoldUps hold_ups_{-1};
};

TEST_F(StopGuardTest, SendsNothingWhileTheProgramGoesOn) {
  std::string missing;
  for (int i = 0; i < 600; ++i) missing += step().missing;
  hold_ups_.note(guard_.process());
  const pid_t process = guard_.process();
  guard_.end();
  EXPECT_FALSE(process > 0 && lives(process));
  heard_ += terminal_.read();
  expectUndisturbed();
  if (!hold_ups_.any()) EXPECT_EQ(missing, "");
}

TEST_F(StopGuardTest, ACycleThatDoesNotStepIsStoppedAndLearnsWhy) {
  step();
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
  // Again and again: the line may lose a byte.
  ASSERT_TRUE(restUntil([&] { return heard_.rfind(std::string(kStop) + kStop, 0) == 0; })) << heard_;
  EXPECT_NE(fcntl(line_, F_GETFL) & O_NONBLOCK, 0);  // the open file is this program's as well
  EXPECT_TRUE(guard_.intervened());
  ASSERT_TRUE(stepUntil([&] { return !interventions_.empty(); }));
  EXPECT_NE(interventions_.find("the program stood still for more than 0.2 s"), std::string::npos);
  // Once: after that it is guarded as before.
  heard_.clear();
  interventions_.clear();
  for (int i = 0; i < 600; ++i) EXPECT_EQ(step().missing, "");
  expectUndisturbed();
  heard_.clear();
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
  ASSERT_TRUE(stepUntil([&] { return !interventions_.empty(); }));
}

/// For a device that does not hear a stop behind another command, nor one behind a stop.
TEST_F(StopGuardTest, StopsCanBeApartAndComeTwiceAtTheEnd) {
  using Clock = std::chrono::steady_clock;
  constexpr double kApart = 0.6;  // s
  const auto stops = [&] {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = heard_.find(kStop, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  // s, from before the first stop was sent to after the second one was heard: a machine that holds this up makes it
  // more.
  const auto expectTwoApart = [&] {
    Clock::time_point earlier = Clock::now(), last = earlier;
    EXPECT_TRUE(restUntil([&] {
      if (stops() >= 1) return true;
      earlier = std::exchange(last, Clock::now());
      return false;
    })) << heard_;
    EXPECT_TRUE(restUntil([&] { return stops() >= 2; })) << heard_;
    EXPECT_GT(std::chrono::duration<double>(Clock::now() - earlier).count(), kApart);
  };
  ASSERT_EQ(guard_.begin(line_, kStop, kApart), "");
  step();
  expectTwoApart();
  step();
  heard_.clear();
  guard_.leave();
  expectTwoApart();
}

TEST_F(StopGuardTest, AStopThatALineDoesNotTakeYetIsSentToItsEnd) {
  std::string full(4096, 'x');  // nobody reads, and the line takes no more
  while (write(line_, full.data(), full.size()) > 0) {
  }
  for (int i = 0; i < 20; ++i) sleepFor(20);  // ticks, as the guard's
  EXPECT_NE(fcntl(line_, F_GETFL) & O_NONBLOCK, 0);
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
  ASSERT_TRUE(stepUntil([&] { return !interventions_.empty(); }));
}

TEST_F(StopGuardTest, AKilledGuardIsNoticedAndReplaced) {
  step();
  const pid_t first = guard_.process();
  signalGuard(SIGKILL);
  bool unguarded = false;
  ASSERT_TRUE(stepUntil([&] {
    unguarded = guard_.process() != first;
    return interventions_.find("the stop guard ended") != std::string::npos;
  }));
  if (!hold_ups_.any()) {
    EXPECT_EQ(interventions_, "the stop guard ended.");
  }
  EXPECT_TRUE(unguarded);
  ASSERT_TRUE(stepUntil([&] { return step().missing.empty(); }));
  EXPECT_NE(guard_.process(), first);
  if (!hold_ups_.any()) EXPECT_EQ(heard_, "");  // its driver sends the stop
  heard_.clear();
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
}

TEST_F(StopGuardTest, AFrozenGuardIsKilledAndReplaced) {
  step();
  const pid_t first = guard_.process();
  signalGuard(SIGSTOP);
  ASSERT_TRUE(stepUntil([&] { return !interventions_.empty(); }));
  EXPECT_EQ(interventions_, "the stop guard stood still for more than 0.2 s.");
  ASSERT_TRUE(stepUntil([&] { return step(), !lives(first); }));
  ASSERT_TRUE(stepUntil([&] { return step().missing.empty(); }));
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
}

/// A debugger that has stopped a process and waits at its prompt; empty where the system allows none.
pid_t startDebugger(pid_t process) {
  int attached[2];
  if (pipe(attached) != 0) return -1;
  const pid_t debugger = fork();
  if (debugger == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const bool done = ptrace(PTRACE_ATTACH, process, nullptr, nullptr) == 0 && waitpid(process, nullptr, 0) == process;
    const char answer = done ? 'y' : 'n';
    if (write(attached[1], &answer, 1) != 1) _exit(1);
    for (;;) pause();
  }
  char answer = 'n';
  const bool heard = read(attached[0], &answer, 1) == 1;
  close(attached[0]);
  close(attached[1]);
  if (heard && answer == 'y') return debugger;
  kill(debugger, SIGKILL);
  waitpid(debugger, nullptr, 0);
  return -1;
}

TEST_F(StopGuardTest, AGuardThatADebuggerHoldsOnToDoesNotHoldTheDriver) {
  step();
  const pid_t first = guard_.process(), debugger = startDebugger(first);
  if (debugger < 0) GTEST_SKIP() << "no process may be debugged here";
  EXPECT_TRUE(stepUntil([&] { return !interventions_.empty(); }));
  EXPECT_TRUE(stepUntil([&] { return step().missing.empty(); }));
  EXPECT_NE(guard_.process(), first);
  EXPECT_TRUE(lives(first)) << "it has ended: the debugger held nothing";
  kill(debugger, SIGKILL);
  waitpid(debugger, nullptr, 0);
  EXPECT_TRUE(stepUntil([&] { return step(), !lives(first); }));
}

std::string contents(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(StopGuardTest, IsNotEndedByTheNameOfItsProgram) {
  const std::string folder = "/proc/" + std::to_string(guard_.process());
  EXPECT_TRUE(stepUntil([&] { return std::string(contents(folder + "/cmdline").c_str()) == "stop_guard"; }));
  EXPECT_EQ(contents(folder + "/comm"), "stop_guard\n");
}

TEST_F(StopGuardTest, LocksItsMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer locks no memory";
#endif
  const pid_t probe = fork();
  if (probe == 0) _exit(mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : 1);
  int status = 0;
  waitpid(probe, &status, 0);
  if (status != 0) GTEST_SKIP() << "this process may not lock enough memory";
  const std::string file = "/proc/" + std::to_string(guard_.process()) + "/status";
  EXPECT_TRUE(stepUntil([&] {
    const std::string text = contents(file);
    const auto at = text.find("VmLck:");
    return at != std::string::npos && std::stol(text.substr(at + 6)) > 0;
  }));
}

TEST_F(StopGuardTest, GuardsThatCannotBeStartedAreReported) {
  step();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit none{0, limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  signalGuard(SIGKILL);
  const bool tried = stepUntil([&] { return step().missing.find("open files") != std::string::npos; });
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  ASSERT_TRUE(tried);
  EXPECT_EQ(guard_.process(), -1);
  ASSERT_TRUE(stepUntil([&] { return step().missing.empty(); }));
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
}

TEST_F(StopGuardTest, AMachineThatStandsStillAsAWholeIsNotTakenForAFrozenProgram) {
  step();
  sleepFor(60);  // it has heard that
  hold_ups_.note(guard_.process());
  signalGuard(SIGSTOP);
  for (int i = 0; i < 30; ++i) sleepFor(20);  // neither the guard nor this program
  signalGuard(SIGCONT);
  hold_ups_.restart(guard_.process());
  for (int i = 0; i < 300; ++i) step();
  expectUndisturbed();
}

/// A program of its own that sends ten commands a cycle, ".", and then why it was stopped.
pid_t startDriver(const std::string& link) {
  const pid_t driver = fork();
  if (driver != 0) return driver;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  SerialPort port({link, 9600});
  port.setGuardedStop(kStop);
  if (!port.open().empty()) _exit(1);
  port.write("begun", 0);
  for (;;) {
    for (int i = 0; i < 10; ++i) port.write(".", 0);
    const std::string why = port.heartbeat().intervention;
    if (!why.empty()) port.write(why, 0);
    port.read(0);
    sleepFor(1);
  }
}

TEST_F(StopGuardTest, AFrozenProgramsDeviceIsStoppedAndHearsNothingElseWhenItIsAliveAgain) {
  guard_.end();
  driver_ = startDriver(link_);
  ASSERT_TRUE(restUntil([&] { return heard_.find("begun...") != std::string::npos; }));
  kill(driver_, SIGSTOP);
  ASSERT_TRUE(restUntil([&] { return hasStopped(); }));
  kill(driver_, SIGCONT);
  ASSERT_TRUE(restUntil([&] { return heard_.find("the program stood still") != std::string::npos; })) << heard_;
  // From the stop to where it knows of it there is nothing but stops, and what it was just about to write.
  std::string between = heard_.substr(heard_.find(kStop), heard_.find("the program stood") - heard_.find(kStop));
  while (between.rfind(kStop, 0) == 0) between.erase(0, sizeof(kStop) - 1);
  EXPECT_LE(between.size(), 1U) << between;
  kill(driver_, SIGSTOP);
  endDriver();  // killed while it stands still: the guard ends, and the line is free
  SerialPort next({link_, 9600});
  EXPECT_TRUE(restUntil([&] { return next.open().empty(); }));
}

}  // namespace
}  // namespace microinjection
