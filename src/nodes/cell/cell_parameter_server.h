#pragma once

#include <cell_microinjection/CellParameters.h>
#include <cell_microinjection/SetCellParameters.h>

#include <mutex>
#include <string>
#include <vector>

#include "cell/choice/make_cell_model.h"
#include "cell/model/placed_cell.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// Changes parameters of the cell while it is served, see MemberChange and PlacedCell. Live it makes the new cell
/// in a thread of its own, so that no step is delayed. In virtual time it does so
/// right before a step, so that all runs are the same.
///
/// In:      /cell/set_parameters (CellParameters)
/// Out:     /cell/parameters (CellParameters, those that have changed: the next forces are those of another cell)
/// Service: ~set_cell_parameters (SetCellParameters)
class CellParameterServer {
 public:
  /// `change`, `place` and `cycle` outlive it. A null `change` refuses everything, with the reason
  /// `unchangeable`.
  /// `place` takes the height, with any model; `radius` (m) bounds it.
  CellParameterServer(MemberChange* change, const std::string& unchangeable, PlacedCell& place, double radius,
                      Cycle& cycle);
  CellParameterServer(const CellParameterServer&) = delete;
  CellParameterServer& operator=(const CellParameterServer&) = delete;

 private:
  void receive(const cell_microinjection::CellParameters& message);
  void call(const cell_microinjection::SetCellParameters::Request& request,
            cell_microinjection::SetCellParameters::Response& response);
  std::string change(const std::vector<std::string>& names, const std::vector<double>& values);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::string changeCell(const std::vector<CellParameter>& parameters);

  const Bus& bus_;
  Publisher<cell_microinjection::CellParameters> changed_;
  MemberChange* change_;
  std::string unchangeable_;
  PlacedCell& place_;
  double highest_;        ///< m, of the cell above its place in the scene
  std::mutex mutex_;      ///< of what follows; the thread that steps never waits for it
  unsigned changes_ = 0;  ///< since the start
  std::string outcome_;   ///< of the last one
  // Last members: their thread uses the others.
  Subscription subscription_;
  BusHandle service_;
};

}  // namespace microinjection
