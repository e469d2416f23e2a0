#include "nodes/runtime/real_time.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <thread>

namespace microinjection {
namespace {

constexpr int kPromptNiceness = -3;  ///< before what is ordinary, and not so far that nothing is left for rviz

}  // namespace

// On Linux the calls of setpriority and sched_setscheduler concern the calling thread alone.

void preferForThread(Priority priority) {
  if (priority == Priority::kRealTime && std::thread::hardware_concurrency() < 2) return;
  const int policy = priority == Priority::kRealTime ? SCHED_RR : SCHED_OTHER;
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(policy);
  sched_setscheduler(0, policy, &parameters);
  if (policy == SCHED_OTHER) setpriority(PRIO_PROCESS, 0, priority == Priority::kPrompt ? kPromptNiceness : 0);
}

void prefer(Priority priority) {
  if (priority == Priority::kOrdinary) return;  // it stays as its launch prefix has it
  preferForThread(priority);
  // Where Linux groups threads by session (autogroup, which most distributions have on), their niceness counts only
  // among themselves, and the group has one of its own. roslaunch gives each node a session; a node that shares one
  // with a shell leaves it as it is.
  const bool has_session = getsid(0) == getpid();
  if (priority == Priority::kPrompt && has_session) std::ofstream("/proc/self/autogroup") << kPromptNiceness;
}

}  // namespace microinjection
