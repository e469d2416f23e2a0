#pragma once

namespace microinjection {

/// Flushes std::cout and stdout. Throws WriteError when that fails or when an earlier write to the
/// standard output failed, as on a full disk. Commands call it before they report success.
void flushStandardOutput();

}  // namespace microinjection
