#include "hardware/serial/stop_guard_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

namespace microinjection {
namespace {

constexpr int kLine = 0, kDriver = 1;  // the guard's descriptors
constexpr int kTick = 20;              // ms
constexpr char kName[] = "stop_guard";

/// Closes every descriptor from `first` on. close_range() is not in every libc.
void closeAllFrom(int first) {
  struct Entry {  // linux_dirent64
    std::uint64_t inode;
    std::int64_t offset;
    unsigned short length;
    unsigned char type;
    char name[1];
  };
  alignas(Entry) char entries[2048];
  const int list = open("/proc/self/fd", O_RDONLY | O_DIRECTORY);
  bool found = list >= 0;
  while (found) {  // restarts, since closed descriptors leave the list
    found = false;
    lseek(list, 0, SEEK_SET);
    const long size = syscall(SYS_getdents64, list, entries, sizeof(entries));
    for (long at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const Entry*>(entries + at);
      int number = 0;
      for (const char* digit = entries + at + offsetof(Entry, name); *digit >= '0' && *digit <= '9'; ++digit)
        number = 10 * number + *digit - '0';
      if (number >= first && number != list && close(number) == 0) found = true;
      at += entry->length;
    }
  }
  if (list >= 0) {
    close(list);
  } else {
    for (int number = first; number < 1024; ++number) close(number);
  }
}

double now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class Guard {
 public:
  Guard(const char* stop, std::size_t size, double apart)
      : stop_(stop), size_(size), apart_(apart), written_(size), last_tick_(now()) {}

  void guardUntilDriverTerminates() {
    while (process()) {
      countSilence();
      report();  // before the stop is written: a driver that resumes in between must not write after it
      write();
      wait(kTick);
    }
  }
  void stopDevice() {
    if (written_ == size_) written_ = 0;  // a partly written stop is completed
    for (write(); written_ < size_; write()) wait(-1);
  }
  void stopDeviceAgain() {
    if (apart_ == 0) return;
    poll(nullptr, 0, static_cast<int>(1e3 * apart_));
    stopDevice();
  }

 private:
  /// Reads all heartbeats. Returns false if the driver has terminated.
  bool process() {
    char beats[64];
    received_ = false;
    for (;;) {
      const ssize_t size = recv(kDriver, beats, sizeof(beats), MSG_DONTWAIT);
      if (size > 0) {
        received_ = true;
      } else if (size == 0 || errno != EINTR) {
        return size < 0 && errno == EAGAIN;
      }
    }
  }

  /// A tick that took much longer counts as one tick: the machine was frozen, and the driver with
  /// it.
  void countSilence() {
    const double time = now(), passed = time - last_tick_;
    last_tick_ = time;
    silence_ = received_ ? 0 : silence_ + (passed < 2e-3 * kTick ? passed : 1e-3 * kTick);
    if (received_) {
      again_ = false;
      reported_ = false;
      send(kStopGuardEcho);
    }
    if (silence_ < (again_ && apart_ > 0 ? apart_ : kStopGuardSilence)) return;
    silence_ = 0;  // repeats the stop after the same time, or `apart`, since the line may lose a byte
    again_ = true;
    stopping_ = true;
    if (written_ == size_) written_ = 0;
  }

  /// The file description is shared with the driver, so it must stay non-blocking.
  void write() {
    while (written_ < size_) {
      const ssize_t written = ::write(kLine, stop_ + written_, size_ - written_);
      if (written > 0) {
        written_ += static_cast<std::size_t>(written);
        last_tick_ = now();  // the time between two stops begins when the first one is in the line
      } else if (written < 0 && errno == EAGAIN) {
        return;
      } else if (written == 0 || errno != EINTR) {
        written_ = size_;  // the line is broken
      }
    }
  }

  void report() {
    if (!stopping_) return;
    if (!reported_) reported_ = send(kStopGuardStopped);
    stopping_ = !reported_;
  }

  static bool send(char message) { return ::send(kDriver, &message, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1; }

  /// Ignores heartbeats, but returns at once when the driver terminates or the line accepts the
  /// rest of a stop.
  void wait(int duration) {
    pollfd ends[2] = {{written_ < size_ ? kLine : -1, POLLOUT, 0}, {duration < 0 ? -1 : kDriver, POLLRDHUP, 0}};
    poll(ends, 2, duration);
  }

  const char* stop_;
  std::size_t size_;
  double apart_;  // s
  std::size_t written_;
  double last_tick_;    // s
  double silence_ = 0;  // s, since the driver's last heartbeat
  bool received_ = false, again_ = false, stopping_ = false, reported_ = false;
};

}  // namespace

CommandLine findCommandLine() {
  std::ifstream file("/proc/self/stat");
  std::string stat;
  std::getline(file, stat);
  std::istringstream fields(stat.substr(stat.rfind(')') + 1));  // the name before it may have spaces
  std::string skipped;
  std::uintptr_t begin = 0, end = 0;
  for (int field = 3; field < 48; ++field) fields >> skipped;  // 48 and 49 are arg_start and arg_end, see proc(5)
  if (!(fields >> begin >> end) || begin == 0 || end <= begin) return {};
  return {reinterpret_cast<char*>(begin), end - begin};
}

void runStopGuard(int line, int driver, const char* stop, std::size_t size, double apart, CommandLine program) {
  setsid();  // a signal to the program's group must not end the guard
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_IGN);
  prctl(PR_SET_NAME, kName);  // nor must a kill by the program's name
  if (program.size > sizeof(kName)) {
    std::memset(program.text, 0, program.size);
    std::memcpy(program.text, kName, sizeof(kName));
  }
  mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT);  // the pages that are there, not the whole address space
  // The guard must keep nothing else open: neither connections nor the socket's other end.
  dup2(line, kLine);
  dup2(driver, kDriver);
  closeAllFrom(3);
  close(2);
  Guard guard(stop, size, apart);
  guard.guardUntilDriverTerminates();
  guard.stopDevice();
  guard.stopDeviceAgain();
  _exit(0);
}

}  // namespace microinjection
