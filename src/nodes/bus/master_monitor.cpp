#include "nodes/bus/master_monitor.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/errors.h"
#include "nodes/bus/lost_publishers.h"
#include "nodes/runtime/real_time.h"

namespace microinjection {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds kQuestionPeriod(0.5);  ///< from a reply to the next request
/// Of this process's running time since the last request that was answered. Long, since real-time nodes that need all
/// of the processor delay this thread and the master; a dead master refuses at once.
constexpr double kReplyTimeout = 5;           // s
constexpr unsigned kRepliesPerLinkCheck = 2;  ///< 1 s between checks for lost publishers

bool isRegistered() {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = request[1] = ros::this_node::getName();
  constexpr bool kWait = false;
  return ros::master::execute("lookupNode", request, response, uri, kWait);
}

}  // namespace

struct MasterMonitor::Shared {
  std::atomic<bool> refused{false};
  std::atomic<double> awake{0};       // s that this process has been running
  std::atomic<double> last_reply{0};  // s of it, of the last request that was answered
  std::atomic<double> away{0};        // s, counted by refused requests: not while this process is frozen
  std::atomic<bool> polled{false};    // masterLostForLong() was called
  double orphan_timeout = 60;         // s
  std::mutex mutex;                   // of the following members, which a step does not use
  std::condition_variable changed;
  unsigned replies = 0;            // the thread's
  LostPublishers lost_publishers;  // the thread's
  bool ending = false;
  bool ended = false;

  void monitor() {
    std::unique_lock<std::mutex> lock(mutex);
    while (!changed.wait_for(lock, kQuestionPeriod, [this] { return ending; })) {
      lock.unlock();
      // The time of the question: a thread that stands still behind the answer must not make it fresh.
      const double asked = awake;
      const bool registered = isRegistered();
      refused = !registered;
      if (registered) last_reply = asked;
      away = registered ? 0 : away + kQuestionPeriod.count();
      if (registered && ++replies % kRepliesPerLinkCheck == 0) {
        const double checked = awake;
        lost_publishers.check();
        last_reply = checked;  // the check waited for replies, too
      }
      if (away > orphan_timeout && !polled) ros::requestShutdown();
      lock.lock();
    }
    ended = true;
    changed.notify_all();
  }
};

MasterMonitor::MasterMonitor() : shared_(std::make_shared<Shared>()) {
  double& timeout = shared_->orphan_timeout;
  ros::param::get("/orphan_timeout", timeout);
  if (!(timeout > 0)) {
    throw ConfigError("/orphan_timeout = " + std::to_string(timeout) + ": must be in (0, inf)");
  }
  std::thread([shared = shared_] {
    preferForThread(Priority::kOrdinary);  // its requests must not delay the hand's loop
    shared->monitor();
  }).detach();
}

MasterMonitor::~MasterMonitor() {
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->ending = true;
  shared_->changed.notify_all();
  // A hanging master blocks the thread, but must not block the node, which may have to stop a
  // device.
  shared_->changed.wait_for(lock, Seconds(1), [this] { return shared_->ended; });
}

void MasterMonitor::step(const ros::SteadyTime& now) {
  awake_.step(now);
  shared_->awake.store(awake_.seconds(), std::memory_order_relaxed);
}

bool MasterMonitor::lost() const {
  return shared_->refused.load(std::memory_order_relaxed) ||
         awake_.seconds() - shared_->last_reply.load(std::memory_order_relaxed) > kReplyTimeout;
}

bool MasterMonitor::masterLostForLong() const {
  shared_->polled.store(true, std::memory_order_relaxed);
  return shared_->away.load(std::memory_order_relaxed) > shared_->orphan_timeout;
}

}  // namespace microinjection
