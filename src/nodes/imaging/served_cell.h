#pragma once

#include <cell_microinjection/SetCellParameters.h>
#include <diagnostic_updater/diagnostic_updater.h>

#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Has cell_simulator serve another cell, with a time limit. A call of a service has none in roscpp:
/// a server that hangs keeps its connection open. So the call has its own thread, but in virtual time,
/// where a server answers at once or not at all.
class ServedCell {
 public:
  /// `timeout`: s of steady time, in which an answer must come.
  ServedCell(Bus& bus, double timeout);
  ~ServedCell();
  ServedCell(const ServedCell&) = delete;
  ServedCell& operator=(const ServedCell&) = delete;

  /// Changes parameters (see CellParameters.msg) and returns the outcome in words. Throws ConfigError
  /// when it is refused, is not answered in time, or an earlier call has no answer yet. Call it in one
  /// thread at a time.
  std::string change(const std::vector<std::string>& names, const std::vector<double>& values);
  /// An error while a call has no answer. Of any thread.
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  struct Call;
  bool isPending() const;
  void callInThread(const std::shared_ptr<Call>& call);

  Bus& bus_;
  double timeout_;
  mutable std::mutex mutex_;    ///< of call_
  std::shared_ptr<Call> call_;  ///< the last one
  std::thread thread_;
};

}  // namespace microinjection
