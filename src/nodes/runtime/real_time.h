#pragma once

namespace microinjection {

/// When a process gets the processor: as any other (kOrdinary); before all that do not run in real time, the cell's
/// solver too, for who must hear every message (kPrompt); in real time (kRealTime), as haptic loops are run: SCHED_RR,
/// lowest priority.
enum class Priority { kOrdinary, kPrompt, kRealTime };

/// Asks the system for it, for the calling thread and those that it starts later. Where the system does not allow it
/// (see `ulimit -r` and `ulimit -e`) nothing changes.
void prefer(Priority priority);

/// The same for the calling thread alone; the process stays what it is.
void preferForThread(Priority priority);

}  // namespace microinjection
