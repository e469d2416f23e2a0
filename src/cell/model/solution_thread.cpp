#include "cell/model/solution_thread.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace microinjection {

SolutionThread::SolutionThread(std::shared_ptr<const LiveCell> cell)
    : cell_(std::move(cell)), thread_([this] { run(); }) {}

SolutionThread::~SolutionThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

// The solving thread holds the lock only to exchange a pointer, but may be suspended while it does.

bool SolutionThread::request(const std::shared_ptr<const ContactPoint>& contact_point, const TipMotion& move) {
  {
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) return false;
    request_ = Request{contact_point, move};
  }
  changed_.notify_all();
  return true;
}

std::shared_ptr<const CellSolution> SolutionThread::poll() {
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
  // A solution takes tens of milliseconds. The threads that step every millisecond have priority.
  // If those run in real time, which this thread inherits, it only needs priority over the rest of
  // the machine. On Linux these calls affect only the calling thread, and their failure does no
  // harm.
  const bool real_time = sched_getscheduler(0) != SCHED_OTHER;
  const sched_param ordinary{};
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  setpriority(PRIO_PROCESS, 0, real_time ? -10 : 5);
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stop_ || request_; });
    if (stop_) return;
    const Request request = std::move(*std::exchange(request_, std::nullopt));
    lock.unlock();
    std::shared_ptr<const CellSolution> solution;
    std::exception_ptr failure;
    try {
      solution = solve(request);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    solution_ = std::move(solution);
    failure_ = failure;
    changed_.notify_all();
  }
}

std::shared_ptr<const CellSolution> SolutionThread::solve(const Request& request) {
  if (!path_ || !request.contact_point->sameAs(contact_point_)) {
    path_ = cell_->path(*request.contact_point);
    contact_point_ = *request.contact_point;
  }
  auto solution = std::make_shared<CellSolution>();
  solution->contact_point = *request.contact_point;
  solution->indentation = path_->follow(request.move);
  solution->rest = path_->rest();
  solution->displacement = path_->surfaceDisplacement();
  solution->members = path_->members();
  solution->border_vertices = path_->borderVertices();
  const auto unused = [](const auto& given) { return given.use_count() == 1; };
  published_.erase(std::remove_if(published_.begin(), published_.end(), unused), published_.end());
  published_.push_back(solution);
  return solution;
}

}  // namespace microinjection
