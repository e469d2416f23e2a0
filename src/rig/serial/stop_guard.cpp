#include "rig/serial/stop_guard.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "rig/serial/stop_guard_process.h"

namespace microinjection {
namespace {

constexpr double kStartInterval = 0.5;  // s, between attempts to start a guard
constexpr int kMostWaits = 1000;        // ms, for the end of a guard that was killed: a debugger may hold on to it
constexpr double kLongestStep = 0.05;   // s: in a longer one this program stood still, and not its guard

double seconds(std::chrono::steady_clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

std::string StopGuard::begin(int line, const std::string& stop) {
  end();
  line_ = line;
  stop_ = stop;
  intervention_.clear();
  return missing_ = start();
}

std::string StopGuard::start() {
  last_start_ = last_heartbeat_ = Clock::now();
  silence_ = 0;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return std::strerror(errno);
  // 0 and 1 are where the guard puts its own.
  const int driver = fcntl(ends[1], F_DUPFD_CLOEXEC, 3), line = fcntl(line_, F_DUPFD_CLOEXEC, 3);
  const CommandLine program = findCommandLine();
  process_ = driver < 0 || line < 0 ? -1 : fork();
  if (process_ == 0) runStopGuard(line, driver, stop_.data(), stop_.size(), program);
  std::string why = process_ < 0 ? std::strerror(errno) : "";
  for (const int each : {ends[1], driver, line}) {
    if (each >= 0) close(each);
  }
  socket_ = ends[0];
  if (!why.empty()) endProcess();
  return why;
}

void StopGuard::receive() {
  char messages[64];
  while (socket_ >= 0) {
    const ssize_t size = recv(socket_, messages, sizeof(messages), MSG_DONTWAIT);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return;
    if (size <= 0) return lose("ended");
    silence_ = 0;
    if (std::memchr(messages, kStopGuardStopped, static_cast<std::size_t>(size)) != nullptr) {
      intervention_ = "the program stood still for more than 0.2 s; the stop guard stopped the device";
    }
  }
}

/// Does not wait for its end: a guard that a debugger holds on to has none until the debugger lets go. What it may
/// still send is the stop, which the driver sends as well.
void StopGuard::lose(const std::string& what) {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    lost_.push_back(process_);
  }
  if (socket_ >= 0) close(socket_);
  process_ = socket_ = -1;
  intervention_ = missing_ = "the stop guard " + what;
}

void StopGuard::reap() {
  const auto ended = [](pid_t process) { return waitpid(process, nullptr, WNOHANG) != 0; };
  lost_.erase(std::remove_if(lost_.begin(), lost_.end(), ended), lost_.end());
}

bool StopGuard::intervened() {
  receive();
  return !intervention_.empty();
}

Wire::GuardReport StopGuard::heartbeat() {
  reap();
  receive();
  const Clock::time_point now = Clock::now();
  if (socket_ >= 0) {
    silence_ += std::min(seconds(now - last_heartbeat_), kLongestStep);
    // A socket that is full belongs to a guard that does not listen, and is found by its silence.
    const bool gone = send(socket_, &kStopGuardBeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL) < 0 && errno == EPIPE;
    if (gone) lose("ended");
    if (silence_ > kStopGuardSilence) lose("stood still for more than 0.2 s");
  }
  last_heartbeat_ = now;
  if (line_ >= 0 && socket_ < 0 && seconds(now - last_start_) > kStartInterval) missing_ = start();
  return {std::exchange(intervention_, ""), missing_};
}

/// Killed it sends nothing, wherever it is in its work; a closed socket alone would have it send the stop.
void StopGuard::endProcess() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) == 0) {
    kill(process_, SIGKILL);
    for (int i = 0; i < kMostWaits && waitpid(process_, nullptr, WNOHANG) == 0; ++i) usleep(1000);
  }
  if (socket_ >= 0) close(socket_);
  process_ = socket_ = -1;
}

void StopGuard::end() {
  endProcess();
  line_ = -1;
}

}  // namespace microinjection
