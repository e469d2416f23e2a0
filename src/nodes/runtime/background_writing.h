#pragma once

#include "base/background_file.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// How a node on this bus writes a file of its own.
inline BackgroundFile::Writing writingOn(const Bus& bus) {
  return bus.isVirtual() ? BackgroundFile::Writing::kAtOnce : BackgroundFile::Writing::kInBackground;
}

}  // namespace microinjection
