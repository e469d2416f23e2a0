#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Refused commands and overridden motions, for the log and the diagnostics.
class CommandLog {
 public:
  /// `bus` outlives it.
  explicit CommandLog(const Bus& bus) : bus_(bus) {}

  /// `refusal`: why the command was refused; empty: it was accepted.
  void addResult(const std::string& command, const std::string& refusal);
  /// An accepted motion ends early for a reason.
  void addOverride(const std::string& motion, const std::string& reason);

  /// Refusal of the last command; empty when it was accepted.
  const std::string& refusal() const { return refusal_; }
  unsigned refused() const { return refused_; }
  /// The last refusal and the last overridden motion since the previous call, or a lasting refusal;
  /// empty: none. Reports are made once a second, with many commands in between.
  std::string takeUpdates();
  void addCounts(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  const Bus& bus_;
  std::string refusal_;
  std::string new_refusal_, new_override_;  ///< since the last report
  std::string logged_;                      ///< the last logged refusal
  double logged_at_ = 0;                    ///< s of steady time
  unsigned refused_ = 0, overridden_ = 0;
};

}  // namespace microinjection
