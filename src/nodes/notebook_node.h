#pragma once

#include <cell_microinjection/CellEstimate.h>
#include <cell_microinjection/CellState.h>
#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/PunctureScore.h>

#include <string>
#include <vector>

#include "nodes/bus/diagnostics.h"
#include "operation/record/injection_notebook.h"

namespace microinjection {

/// Writes one row of a CSV file for each cell that the needle has touched: what was estimated, what was
/// predicted and met, and what came of it. A row is written when the controller is idle again, which it is
/// with the needle out of the cell.
///
/// In: /controller/injection_state, /cell/estimate, /cell/puncture_score, /cell/state (its parameters)
///
/// Parameters: file (required), cell (name for the rows)
class NotebookNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit NotebookNode(Bus& bus);

 private:
  void onStatus(const cell_microinjection::InjectionStatus& message);
  void onEstimate(const cell_microinjection::CellEstimate& message);
  void onScore(const cell_microinjection::PunctureScore& message);
  void onCell(const cell_microinjection::CellState& message);
  void write(const cell_microinjection::InjectionStatus& message);
  void finish();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  const Bus& bus_;
  std::string file_, cell_;
  NotebookEntry entry_;  ///< of the present cell
  bool touched_ = false;
  cell_microinjection::InjectionStatus last_;  ///< newest in a cell
  unsigned written_ = 0;
  std::string error_;
  std::vector<Subscription> subscriptions_;
  Diagnostics diagnostics_;
  BusHandle timer_;
};

}  // namespace microinjection
