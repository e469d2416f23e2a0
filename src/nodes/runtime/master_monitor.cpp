#include "nodes/runtime/master_monitor.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/errors.h"
#include "nodes/runtime/lost_publishers.h"
#include "nodes/runtime/real_time.h"

namespace microinjection {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kPeriod(0.5);  ///< from an answer to the next question
/// Without an answer. Long, since this thread and the master come last where nodes that run in real time need all of
/// the processor; one that has died refuses at once.
constexpr Seconds kPatience(5);
constexpr unsigned kAnswersALinkCheck = 2;  ///< 1 s from one look for lost publishers to the next

bool masterKnowsUs() {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = request[1] = ros::this_node::getName();
  constexpr bool kWait = false;
  return ros::master::execute("lookupNode", request, response, uri, kWait);
}

}  // namespace

struct MasterMonitor::Shared {
  std::atomic<bool> refused{false};
  std::atomic<Clock::time_point> answered{Clock::now()};
  std::atomic<double> away{0};     // s, counted by questions that were refused: not while this process stands still
  std::atomic<bool> asked{false};  // whether `masterLostForLong` was
  double orphan_timeout = 60;      // s
  std::mutex mutex;                // of what follows, which a step does not look at
  std::condition_variable changed;
  unsigned answers = 0;            // the thread's
  LostPublishers lost_publishers;  // the thread's
  bool ending = false;
  bool ended = false;

  void monitor() {
    std::unique_lock<std::mutex> lock(mutex);
    while (!changed.wait_for(lock, kPeriod, [this] { return ending; })) {
      lock.unlock();
      const bool known = masterKnowsUs();
      refused = !known;
      if (known) answered = Clock::now();
      away = known ? 0 : away + kPeriod.count();
      if (known && ++answers % kAnswersALinkCheck == 0) {
        lost_publishers.check();
        answered = Clock::now();  // it asked the master more, which took its time and answered
      }
      if (away > orphan_timeout && !asked) ros::requestShutdown();
      lock.lock();
    }
    ended = true;
    changed.notify_all();
  }
};

MasterMonitor::MasterMonitor(bool timed) : timed_(timed), shared_(std::make_shared<Shared>()) {
  double& timeout = shared_->orphan_timeout;
  ros::param::get("/orphan_timeout", timeout);
  if (!(timeout > 0)) {
    throw ConfigError("/orphan_timeout = " + std::to_string(timeout) + ": must be in (0, inf)");
  }
  std::thread([shared = shared_] {
    preferForThread(Priority::kOrdinary);  // its questions are nothing that the hand's loop should wait for
    shared->monitor();
  }).detach();
}

MasterMonitor::~MasterMonitor() {
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->ending = true;
  shared_->changed.notify_all();
  // A master that hangs keeps the thread, but not the node, which may have a device to stop.
  shared_->changed.wait_for(lock, Seconds(1), [this] { return shared_->ended; });
}

bool MasterMonitor::lost() const {
  if (shared_->refused.load(std::memory_order_relaxed)) return true;
  return timed_ && Clock::now() - shared_->answered.load(std::memory_order_relaxed) > kPatience;
}

bool MasterMonitor::masterLostForLong() const {
  shared_->asked.store(true, std::memory_order_relaxed);
  return shared_->away.load(std::memory_order_relaxed) > shared_->orphan_timeout;
}

}  // namespace microinjection
