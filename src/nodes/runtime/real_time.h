#pragma once

namespace microinjection {

/// Scheduling of a process.
/// - kOrdinary: as any other.
/// - kPrompt: before all that do not run in real time, also the cell's solver; for nodes that must
///   receive every message.
/// - kRealTime: SCHED_RR, lowest priority, as usual for haptic loops.
enum class Priority { kOrdinary, kPrompt, kRealTime };

/// Requests it for the calling thread and those that it starts later. Nothing changes where the
/// system does not allow it (see `ulimit -r` and `ulimit -e`).
void prefer(Priority priority);

/// The same for the calling thread alone.
void preferForThread(Priority priority);

}  // namespace microinjection
