#include "base/console_relay.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace microinjection {
namespace {

constexpr std::size_t kMostWaiting = 1 << 20;  // bytes
constexpr std::chrono::milliseconds kWriteTimeout(500);

// A crash restores these outputs, because its message would be lost in a pipe that nobody reads any
// more.
std::array<int, 2> real_outputs{-1, -1};
std::terminate_handler terminate_before = nullptr;

void restoreOutputs() {
  for (int i = 0; i < 2; ++i) {
    if (real_outputs[i] >= 0) dup2(real_outputs[i], STDOUT_FILENO + i);
  }
}

[[noreturn]] void onTerminate() {
  restoreOutputs();
  if (terminate_before) terminate_before();
  std::abort();
}

bool isSameFile(int one, int other) {
  struct stat a {
  }, b{};
  return fstat(one, &a) == 0 && fstat(other, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

void relay(int file, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno == EAGAIN) {  // another process has set the terminal to O_NONBLOCK
      pollfd terminal{file, POLLOUT, 0};
      poll(&terminal, 1, -1);
    } else if (count < 0 && errno != EINTR) {
      return;  // there is no reader any more
    } else if (count > 0) {
      done += static_cast<std::size_t>(count);
    }
  }
}

}  // namespace

struct ConsoleRelay::Shared {
  struct Chunk {
    int stream;  // 0: standard output, 1: standard error
    std::string text;
  };

  std::array<int, 2> pipes{-1, -1};  // the ends that this process reads
  std::mutex mutex;                  // protects the members below
  std::condition_variable changed;
  std::deque<Chunk> waiting;
  std::size_t waiting_bytes = 0;
  std::uint64_t dropped_unreported = 0;  // lines
  bool ended = false;                    // nothing more will be read
  bool written = false;                  // the writing thread has ended

  bool open();
  void read();
  void queue(int stream, std::string text);
  void write();
};

bool ConsoleRelay::Shared::open() {
  std::fflush(nullptr);
  // Both streams share one pipe if they have the same destination, so that lines keep their order.
  const bool same = isSameFile(STDOUT_FILENO, STDERR_FILENO);
  int input = -1;
  for (int i = 0; i < 2; ++i) {
    const int stream = STDOUT_FILENO + i;
    real_outputs[i] = fcntl(stream, F_DUPFD_CLOEXEC, 3);
    if (real_outputs[i] < 0) return false;
    if (i == 0 || !same) {
      int ends[2];
      if (pipe2(ends, O_CLOEXEC) != 0) return false;
      pipes[i] = ends[0];
      input = ends[1];
      fcntl(input, F_SETPIPE_SZ, static_cast<int>(kMostWaiting));
      fcntl(input, F_SETFL, O_NONBLOCK);  // if even the reading thread gets no processor time, a line is lost
    }
    if (dup2(input, stream) < 0) return false;
    if (i == 1 || !same) close(input);
  }
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  return true;
}

void ConsoleRelay::Shared::read() {
  std::array<pollfd, 2> inputs{{{pipes[0], POLLIN, 0}, {pipes[1], POLLIN, 0}}};
  std::array<char, 65536> buffer;
  while (inputs[0].fd >= 0 || inputs[1].fd >= 0) {
    if (poll(inputs.data(), inputs.size(), -1) < 0) continue;
    for (int i = 0; i < 2; ++i) {
      if (inputs[i].fd < 0 || inputs[i].revents == 0) continue;
      const ssize_t size = ::read(inputs[i].fd, buffer.data(), buffer.size());
      if (size > 0) queue(i, std::string(buffer.data(), static_cast<std::size_t>(size)));
      if (size == 0) inputs[i].fd = -1;
    }
  }
  const std::lock_guard<std::mutex> lock(mutex);
  ended = true;
  changed.notify_all();
}

void ConsoleRelay::Shared::queue(int stream, std::string text) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (waiting_bytes + text.size() > kMostWaiting) {
    dropped_unreported += static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
    return;
  }
  if (dropped_unreported > 0) {
    waiting.push_back(
        {1, std::to_string(dropped_unreported) + " lines of output are missing here: nobody took them\n"});
    dropped_unreported = 0;
  }
  waiting_bytes += text.size();
  waiting.push_back({stream, std::move(text)});
  changed.notify_all();
}

void ConsoleRelay::Shared::write() {
  std::unique_lock<std::mutex> lock(mutex);
  while (true) {
    changed.wait(lock, [this] { return ended || !waiting.empty(); });
    if (waiting.empty()) break;
    const Chunk chunk = std::move(waiting.front());
    waiting.pop_front();
    lock.unlock();
    relay(real_outputs[chunk.stream], chunk.text);
    lock.lock();
    waiting_bytes -= std::min(waiting_bytes, chunk.text.size());
  }
  written = true;
  changed.notify_all();
}

ConsoleRelay::ConsoleRelay() : shared_(std::make_shared<Shared>()) {
  if (!shared_->open()) {
    restoreOutputs();
    shared_.reset();
    return;
  }
  terminate_before = std::set_terminate(onTerminate);
  std::thread([shared = shared_] { shared->read(); }).detach();
  std::thread([shared = shared_] { shared->write(); }).detach();
}

ConsoleRelay::~ConsoleRelay() {
  if (!shared_) return;
  std::fflush(nullptr);
  std::set_terminate(terminate_before);
  restoreOutputs();  // closes the pipes' write ends, unless child processes hold them
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->changed.wait_for(lock, kWriteTimeout, [this] { return shared_->written; });
}

}  // namespace microinjection
