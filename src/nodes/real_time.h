#pragma once

namespace microinjection {

/// Asks the system to run this process before ordinary ones (SCHED_RR, lowest priority), as haptic loops are run.
/// Threads that are started later inherit it. Where the system does not allow it (see `ulimit -r`) nothing changes.
void preferRealTime();

}  // namespace microinjection
