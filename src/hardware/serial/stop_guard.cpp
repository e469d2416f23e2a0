#include "hardware/serial/stop_guard.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "hardware/serial/stop_guard_process.h"

namespace microinjection {
namespace {

constexpr double kStartInterval = 0.5;  // s, between attempts to start a guard
constexpr int kMostWaits = 1000;        // ms, to wait for the end of a killed guard, which a debugger may delay
constexpr double kLongestStep = 0.05;   // s; a longer step means that this program was frozen, not its guard

double seconds(std::chrono::steady_clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

std::string StopGuard::begin(int line, const std::string& stop, double apart) {
  end();
  line_ = line;
  stop_ = stop;
  apart_ = apart;
  intervention_.clear();
  return missing_ = start();
}

std::string StopGuard::start() {
  last_start_ = last_heartbeat_ = Clock::now();
  silence_ = 0;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return std::strerror(errno);
  // The guard uses descriptors 0 and 1 for its own purposes.
  const int driver = fcntl(ends[1], F_DUPFD_CLOEXEC, 3), line = fcntl(line_, F_DUPFD_CLOEXEC, 3);
  const CommandLine program = findCommandLine();
  process_ = driver < 0 || line < 0 ? -1 : fork();
  if (process_ == 0) runStopGuard(line, driver, stop_.data(), stop_.size(), apart_, program);
  std::string reason = process_ < 0 ? std::strerror(errno) : "";
  for (const int each : {ends[1], driver, line}) {
    if (each >= 0) close(each);
  }
  socket_ = ends[0];
  if (!reason.empty()) endProcess();
  return reason;
}

void StopGuard::receive() {
  char messages[64];
  while (socket_ >= 0) {
    const ssize_t size = recv(socket_, messages, sizeof(messages), MSG_DONTWAIT);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return;
    if (size <= 0) return markLost("ended");
    silence_ = 0;
    if (std::memchr(messages, kStopGuardStopped, static_cast<std::size_t>(size)) != nullptr) {
      intervention_ = "the program stood still for more than 0.2 s; the stop guard stopped the device";
    }
  }
}

/// Does not wait for the guard's end, which a debugger can delay. The guard may still send the
/// stop, but the driver sends it as well.
void StopGuard::markLost(const std::string& what) {
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
    // A full socket belongs to a frozen guard, which its silence reveals.
    const bool gone = send(socket_, &kStopGuardBeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL) < 0 && errno == EPIPE;
    if (gone) markLost("ended");
    if (silence_ > kStopGuardSilence) markLost("stood still for more than 0.2 s");
  }
  last_heartbeat_ = now;
  if (line_ >= 0 && socket_ < 0 && seconds(now - last_start_) > kStartInterval) missing_ = start();
  return {std::exchange(intervention_, ""), missing_};
}

/// A killed guard sends nothing. If only the socket were closed, it would send the stop.
void StopGuard::endProcess() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) == 0) {
    kill(process_, SIGKILL);
    for (int i = 0; i < kMostWaits && waitpid(process_, nullptr, WNOHANG) == 0; ++i) usleep(1000);
  }
  if (socket_ >= 0) close(socket_);
  process_ = socket_ = -1;
}

void StopGuard::leave() {
  if (socket_ >= 0) close(socket_);
  process_ = socket_ = line_ = -1;
}

void StopGuard::end() {
  endProcess();
  line_ = -1;
}

}  // namespace microinjection
