#include "nodes/runtime/real_time.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <thread>

namespace microinjection {
namespace {

constexpr int kPromptNiceness = -3;  ///< before ordinary processes, but leaves time for rviz

}  // namespace

// On Linux setpriority and sched_setscheduler affect the calling thread alone.

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
  // With autogroup (on in most distributions) Linux groups threads by session: their niceness
  // counts only within the group, which has its own. roslaunch gives each node a session; a node in
  // a shell's session does not change the group.
  const bool has_session = getsid(0) == getpid();
  if (priority == Priority::kPrompt && has_session) std::ofstream("/proc/self/autogroup") << kPromptNiceness;
}

}  // namespace microinjection
