#pragma once

namespace microinjection {

/// Writes out what std::cout and stdout still hold. Throws WriteError when that fails or when an earlier write to the
/// standard output has failed, as on a full disk. A command calls it before it reports success.
void flushStandardOutput();

}  // namespace microinjection
