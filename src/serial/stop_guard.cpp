#include "serial/stop_guard.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace microinjection {
namespace {

/// Closes every descriptor from `first` on, without what may not be called here: close_range() is not in every libc.
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
  while (found) {  // from the start again, since what is closed leaves the list
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

/// The guard: after fork in a program with threads only what is safe in a signal handler may be called.
[[noreturn]] void guard(int line, int parent, const char* words, std::size_t size) {
  setsid();  // what ends the program's whole group must not end this one
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_IGN);
  prctl(PR_SET_NAME, "stop_guard");  // nor what ends programs by their name
  // Nothing else may be kept open: neither connections nor the pipe's other end.
  dup2(line, 0);
  dup2(parent, 1);
  closeAllFrom(3);
  close(2);
  char farewell = 0;
  ssize_t got = 0;
  while ((got = read(1, &farewell, 1)) < 0 && errno == EINTR) {
  }
  if (got == 0) {
    fcntl(0, F_SETFL, fcntl(0, F_GETFL) & ~O_NONBLOCK);
    while (size > 0) {
      const ssize_t written = write(0, words, size);
      if (written <= 0) break;
      words += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  _exit(0);
}

}  // namespace

std::string StopGuard::begin(int line, const std::string& words) {
  end();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return std::strerror(errno);
  // 0 and 1 are where the guard puts its own.
  const int parent = fcntl(ends[0], F_DUPFD_CLOEXEC, 3), tty = fcntl(line, F_DUPFD_CLOEXEC, 3);
  guard_ = parent < 0 || tty < 0 ? -1 : fork();
  if (guard_ == 0) guard(tty, parent, words.data(), words.size());
  std::string why = guard_ < 0 ? std::strerror(errno) : "";
  for (const int each : {ends[0], parent, tty}) {
    if (each >= 0) close(each);
  }
  parent_ = ends[1];
  if (!why.empty()) end();
  return why;
}

void StopGuard::end() {
  if (parent_ >= 0) {
    const char farewell = 'x';
    [[maybe_unused]] const ssize_t said = write(parent_, &farewell, 1);  // a guard that is gone says nothing either
    close(parent_);
  }
  if (guard_ > 0) {
    while (waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  guard_ = parent_ = -1;
}

}  // namespace microinjection
