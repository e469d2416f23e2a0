#include "commands/solve_paths.h"

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "base/errors.h"
#include "base/worker_processes.h"

namespace microinjection {
namespace {

constexpr int kBadUsage = 2;
constexpr auto kWait = std::chrono::seconds(5);

/// What is done of a number of paths, and the time left.
class ProgressLine {
 public:
  ProgressLine(const std::string& title, std::size_t paths) : title_(title), all_(paths) { show(); }
  ~ProgressLine() { std::fprintf(stderr, "\n"); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void advance() {
    ++done_;
    show();
  }

 private:
  void show() const {
    constexpr std::size_t kWidth = 30;
    const std::string bar(kWidth * done_ / all_, '#');
    const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::fprintf(stderr, "\r%s: [%-*s] %zu of %zu paths, %.0f s", title_.c_str(), static_cast<int>(kWidth), bar.c_str(),
                 done_, all_, spent);
    const double left = spent * static_cast<double>(all_ - done_) / static_cast<double>(done_);
    if (done_ > 0) std::fprintf(stderr, ", about %.0f s left ", left);
    std::fflush(stderr);
  }

  const std::string& title_;
  std::size_t done_ = 0, all_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void solvePaths(const std::string& title, int jobs,
                const std::function<std::vector<std::vector<std::string>>()>& missing) {
  for (auto commands = missing(); !commands.empty(); commands = missing()) {
    std::size_t busy = 0;
    {
      ProgressLine progress(title, commands.size());
      runWorkers(commands, jobs, [&](std::size_t, int status) {
        const char* failed = "a path failed, see above";
        if (status == kBadUsage) throw ConfigError(failed);
        if (status != 0 && status != kBusyStatus) throw std::runtime_error(failed);
        busy += status == kBusyStatus;
        progress.advance();
      });
    }
    if (busy == commands.size()) std::this_thread::sleep_for(kWait);
  }
}

}  // namespace microinjection
