#pragma once

namespace microinjection {

/// Prepares a process that solves one piece of a larger work: one thread, and a memory allocator
/// that keeps large blocks. `ends_with_parent`: it is killed when its parent ends.
void prepareWorker(bool ends_with_parent);

}  // namespace microinjection
