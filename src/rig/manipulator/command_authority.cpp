#include "rig/manipulator/command_authority.h"

namespace microinjection {

bool CommandAuthority::authorize(const std::string& source, double time, bool moving) {
  if (!fault_.empty()) return false;
  const bool free = authorized_source_.empty() || (!moving && time > commanded_);
  if (source != authorized_source_ && !free) {
    fault_ = "two nodes command the needle: " + authorized_source_ + " and " + source;
    return false;
  }
  authorized_source_ = source;
  commanded_ = time;
  return true;
}

void CommandAuthority::clear() {
  fault_.clear();
  authorized_source_.clear();
}

}  // namespace microinjection
