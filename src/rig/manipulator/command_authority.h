#pragma once

#include <limits>
#include <string>

namespace microinjection {

/// Lets one source command the needle at a time. The first that commands has the authority until nothing moves any
/// more. A command of another source meanwhile is a fault: two that drive one needle know nothing of each other's
/// limits. The fault lasts until clear().
class CommandAuthority {
 public:
  /// A command of `source` at `time` (s), the same for all commands of a step. `moving`: the needle still does what it
  /// was told before. Whether the command may be obeyed: without a fault.
  bool authorize(const std::string& source, double time, bool moving);

  /// Who commands beside whom; empty without a fault.
  const std::string& fault() const { return fault_; }
  void clear();

 private:
  std::string authorized_source_;                                ///< empty: none yet
  double commanded_ = -std::numeric_limits<double>::infinity();  ///< s, the holder's last command
  std::string fault_;
};

}  // namespace microinjection
