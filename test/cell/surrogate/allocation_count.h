#pragma once

#include <cstddef>

namespace microinjection {

/// Blocks that the calling thread has taken from the heap so far: by new, by Eigen (which calls malloc) or any other
/// way.
std::size_t allocationCount();

}  // namespace microinjection
