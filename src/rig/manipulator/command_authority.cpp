#include "rig/manipulator/command_authority.h"

namespace microinjection {

bool CommandAuthority::admit(const std::string& source, double time, bool moving) {
  if (!fault_.empty()) return false;
  const bool free = holder_.empty() || (!moving && time > commanded_);
  if (source != holder_ && !free) {
    fault_ = "two nodes command the needle: " + holder_ + " and " + source;
    return false;
  }
  holder_ = source;
  commanded_ = time;
  return true;
}

void CommandAuthority::clear() {
  fault_.clear();
  holder_.clear();
}

}  // namespace microinjection
