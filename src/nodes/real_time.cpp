#include "nodes/real_time.h"

#include <sched.h>

#include <thread>

namespace microinjection {

void preferRealTime() {
  if (std::thread::hardware_concurrency() < 2) return;
  sched_param priority{};
  priority.sched_priority = sched_get_priority_min(SCHED_RR);
  sched_setscheduler(0, SCHED_RR, &priority);
}

}  // namespace microinjection
