#include "commands/run_tasks.h"

#include <malloc.h>
#include <sys/prctl.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "base/errors.h"
#include "base/exit_status.h"
#include "base/worker_processes.h"
#include "cell/mechanics/symmetric_solver.h"

namespace microinjection {
namespace {

constexpr auto kWait = std::chrono::seconds(5);

/// What is done of a number of tasks, and the time left.
class ProgressLine {
 public:
  ProgressLine(const std::string& title, const std::string& unit, std::size_t tasks)
      : title_(title), unit_(unit), all_(tasks) {
    show();
  }
  ~ProgressLine() { std::fprintf(stderr, "\n"); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void advance(std::size_t tasks) {
    done_ += tasks;
    show();
  }

 private:
  void show() const {
    constexpr std::size_t kWidth = 30;
    const std::string bar(kWidth * done_ / all_, '#');
    const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::fprintf(stderr, "\r%s: [%-*s] %zu of %zu %s, %.0f s", title_.c_str(), static_cast<int>(kWidth), bar.c_str(),
                 done_, all_, unit_.c_str(), spent);
    const double left = spent * static_cast<double>(all_ - done_) / static_cast<double>(done_);
    if (done_ > 0) std::fprintf(stderr, ", about %.0f s left ", left);
    std::fflush(stderr);
  }

  const std::string &title_, &unit_;
  std::size_t done_ = 0, all_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

void runTasks(const std::string& title, const std::string& unit, int jobs,
              const std::function<std::vector<Work>()>& missing) {
  for (auto work = missing(); !work.empty(); work = missing()) {
    std::vector<std::vector<std::string>> commands;
    std::size_t tasks = 0, busy = 0;
    for (const Work& each : work) {
      commands.push_back(each.command);
      tasks += each.tasks;
    }
    {
      ProgressLine progress(title, unit, tasks);
      runWorkers(commands, jobs, [&](std::size_t index, int status) {
        const char* failed = "a task failed, see above";
        if (status == kBadUsage) throw ConfigError(failed);
        if (status != 0 && status != kBusyStatus) throw std::runtime_error(failed);
        busy += status == kBusyStatus;
        progress.advance(work[index].tasks);
      });
    }
    if (busy == commands.size()) std::this_thread::sleep_for(kWait);
  }
}

void prepareWorker(bool ends_with_parent) {
  if (ends_with_parent) prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The solver allocates and releases large blocks in every step: the system need not have them back.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  SymmetricSolver::useOneThread();  // pieces are solved side by side; more threads only wait for each other
}

}  // namespace microinjection
