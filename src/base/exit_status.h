#pragma once

namespace microinjection {

/// Exit statuses that several commands share; the help of each command lists all of its own.
constexpr int kDone = 0, kBadUsage = 2, kFailed = 3;

}  // namespace microinjection
