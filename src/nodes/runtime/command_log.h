#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>

namespace microinjection {

/// What became of commands, for the log and the diagnostics: those that were refused and those that others replaced
/// before they were carried out.
class CommandLog {
 public:
  /// `refusal`: why the command was refused; empty: it was obeyed.
  void answered(const std::string& command, const std::string& refusal);
  /// A motion that was accepted ends early, and why.
  void overridden(const std::string& motion, const std::string& why);

  /// Of the last command; empty when it was obeyed.
  const std::string& refusal() const { return refusal_; }
  /// The last refusal and the last overridden motion since the call before, or a refusal that lasts; empty: none. A
  /// report comes once a second, and many commands in between.
  std::string takeUpdates();
  void addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  std::string refusal_;
  std::string refused_news_, overridden_news_;  ///< since the last report
  std::string logged_;                          ///< the last refusal that is in the log
  double logged_at_ = 0;                        ///< s of steady time
  unsigned refused_ = 0, overridden_ = 0;
};

}  // namespace microinjection
