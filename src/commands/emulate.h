#pragma once

#include <string>

namespace microinjection {

/// The program emulate_RIG: the rig's emulator on a pseudo-terminal until it is interrupted. Returns its exit status.
int emulate(const std::string& rig, int argc, char** argv);

}  // namespace microinjection
