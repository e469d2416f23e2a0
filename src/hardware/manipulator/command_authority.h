#pragma once

#include <limits>
#include <string>

namespace microinjection {

/// Admits one command source at a time. The first source has the authority until the needle is at
/// rest. A command from another source meanwhile is a fault, because neither source knows the
/// other's limits. The fault lasts until clear().
class CommandAuthority {
 public:
  /// `commanded`: what the sources command, for the text of a fault.
  explicit CommandAuthority(const std::string& commanded = "the needle") : commanded_what_(commanded) {}

  /// Registers a command of `source` at `time` (s), which is the same for all commands of a step.
  /// Returns true if the command may be executed: without a fault.
  bool authorize(const std::string& source, double time);
  /// To be called at the end of each step. Once the needle rests (`moving` is false) after the last
  /// command, another source may command, also if the device then corrects its position.
  void step(double time, bool moving);

  /// Names both sources; empty without a fault.
  const std::string& fault() const { return fault_; }
  void clear();

 private:
  std::string commanded_what_;
  std::string authorized_source_;                                ///< empty: any may command
  double commanded_ = -std::numeric_limits<double>::infinity();  ///< s, of the authorized source's last command
  std::string fault_;
};

}  // namespace microinjection
