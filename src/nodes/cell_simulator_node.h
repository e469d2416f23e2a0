#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <memory>
#include <optional>
#include <string>

#include "cell/choice/make_cell_model.h"
#include "cell/model/placed_cell.h"
#include "cell_microinjection/BoreState.h"
#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/InjectorState.h"
#include "nodes/cell/cell_holding.h"
#include "nodes/cell/cell_parameter_server.h"
#include "nodes/cell/cell_state_publisher.h"
#include "nodes/cell/piezo_train.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The cell under the needle, see makeCellModel. An invalid force has stamp 0.
///
/// In:  /needle/measured_cp or /needle/true_cp (PoseStamped, tip in `world`); of a cell with membranes that of
/// PiezoTrain;
///      of a needle with a bore /injector/state (InjectorState, the pressure in it); with a holder those of CellHolding
/// Out: /cell/predicted_cf (WrenchStamped, of the cell on the tip, in `world`), /cell/contact (CellContact, on change
///      and each 20 ms), /cell/state (CellState); of a needle with a bore /cell/bore (BoreState, 200 Hz); with a
///      holder those of CellHolding
/// The cell's parameters change by CellParameterServer.
///
/// Parameters: config/cell_simulator.yaml
class CellSimulatorNode {
 public:
  static const char* const kHelp;
  /// Meshes the cell, which may take seconds the first time. @throws ConfigError
  explicit CellSimulatorNode(Bus& bus);

 private:
  struct Parameters {
    std::string scene;
    std::string model = "auto";
    std::string needle = "measured";
    double rate = 1000;
    double state_rate = 60;
    double needle_timeout = 0.05;
    CellModelConfig models;
    CellHolding::Config holding;
    static Parameters read(const Bus& bus);
  };

  ChosenCellModel makeCell(const Scene& scene) const;
  void makeHolding(const Scene& scene);
  void step(const Cycle::Tick& tick);
  std::optional<CellModel::Solution> solution(const ros::Time& now) const;
  CellMoment moment(const ros::Time& now, const TipForce& force) const;
  void publishContact(const ros::Time& now);
  void readInjector(const ros::Time& now);
  void publishBore(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  Cycle cycle_;
  ChosenCellModel chosen_;
  std::unique_ptr<PlacedCell> cell_;
  Input<geometry_msgs::PoseStamped>& needle_;
  Output<geometry_msgs::WrenchStamped>& force_;
  Output<cell_microinjection::CellContact>& contact_;
  Output<cell_microinjection::CellState>& state_;
  Input<cell_microinjection::InjectorState>* injector_ = nullptr;  ///< these two are of a needle with a bore
  Output<cell_microinjection::BoreState>* bore_ = nullptr;
  std::unique_ptr<CellHolding> holding_;  ///< null: the cell is fixed to its pipette
  ros::Time bore_published_;
  double bore_volume_ = 0;  ///< m^3, then
  cell_microinjection::CellContact last_contact_;
  bool can_be_punctured_ = false;
  std::optional<PiezoTrain> piezo_;
  std::string invalid_reason_;  ///< why the last force was invalid; else empty
  // Last members: their threads use the others.
  std::unique_ptr<CellStatePublisher> state_publisher_;
  std::unique_ptr<CellParameterServer> parameter_server_;
};

}  // namespace microinjection
