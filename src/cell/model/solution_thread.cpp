#include "cell/model/solution_thread.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace microinjection {

SolutionThread::SolutionThread(std::shared_ptr<const OnlineCell> cell)
    : cell_(std::move(cell)), thread_([this] { run(); }) {}

SolutionThread::~SolutionThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

// The solving thread has the lock for the exchange of a pointer, but may lose the processor while it does.

bool SolutionThread::request(const std::shared_ptr<const ContactPoint>& place, const TipMotion& move) {
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) return false;
    request_ = Request{place, move};
  }
  changed_.notify_all();
  return true;
}

std::shared_ptr<const CellSolution> SolutionThread::take() {
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock) return nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::exchange(solution_, nullptr);
}

std::shared_ptr<const CellSolution> SolutionThread::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return solution_ || failure_; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  return std::exchange(solution_, nullptr);
}

void SolutionThread::run() {
  // A solution takes tens of milliseconds; the threads that step the chain every millisecond come first. Where those
  // run in real time, and this one inherits it, it need only come before the rest of the machine. On Linux these calls
  // concern the calling thread alone, and they may fail without harm.
  const bool real_time = sched_getscheduler(0) != SCHED_OTHER;
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  setpriority(PRIO_PROCESS, 0, real_time ? -10 : 5);
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || request_; });
    if (stop_) return;
    const Request question = std::move(*std::exchange(request_, std::nullopt));
    lock.unlock();
    std::shared_ptr<const CellSolution> answer;
    std::exception_ptr failure;
    try {
      answer = solve(question);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    solution_ = std::move(answer);
    failure_ = failure;
    changed_.notify_all();
  }
}

std::shared_ptr<const CellSolution> SolutionThread::solve(const Request& question) {
  if (!path_ || !question.place->sameAs(place_)) {
    path_ = cell_->path(*question.place);
    place_ = *question.place;
  }
  auto solution = std::make_shared<CellSolution>();
  solution->place = *question.place;
  solution->indentation = path_->follow(question.move);
  solution->rest = path_->rest();
  solution->displacement = path_->surfaceDisplacement();
  solution->members = path_->members();
  const auto unused = [](const auto& given) { return given.use_count() == 1; };
  published_.erase(std::remove_if(published_.begin(), published_.end(), unused), published_.end());
  published_.push_back(solution);
  return solution;
}

}  // namespace microinjection
