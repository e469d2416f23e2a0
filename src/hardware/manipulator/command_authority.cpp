#include "hardware/manipulator/command_authority.h"

namespace microinjection {

bool CommandAuthority::authorize(const std::string& source, double time) {
  if (!fault_.empty()) return false;
  if (source != authorized_source_ && !authorized_source_.empty()) {
    fault_ = "two nodes command " + commanded_what_ + ": " + authorized_source_ + " and " + source;
    return false;
  }
  authorized_source_ = source;
  commanded_ = time;
  return true;
}

void CommandAuthority::step(double time, bool moving) {
  if (!moving && time > commanded_) authorized_source_.clear();
}

void CommandAuthority::clear() {
  fault_.clear();
  authorized_source_.clear();
}

}  // namespace microinjection
