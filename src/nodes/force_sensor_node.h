#pragma once

#include <cell_microinjection/CalibrateForce.h>
#include <cell_microinjection/InjectionStatus.h>
#include <cell_microinjection/OperatingState.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/background_file.h"
#include "base/repetition.h"
#include "hardware/sensor/force_readout.h"
#include "nodes/needle/force_sources.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The force sensor at the pipette: a simulated two-axis MEMS sensor, voltages on a serial line, or
/// another node's wrench. A two-axis sensor measures along its z (axial) and x (lateral). Its pose
/// is read from tf once, at the start.
///
/// In:  simulated: /cell/predicted_cf (WrenchStamped, `world`), /needle/measured_cp (PoseStamped,
///                 for the pipette's axes)
///      topic:     /force_sensor/device_cf (WrenchStamped in any frame that tf connects to
///                 `needle_tip`)
///      /controller/operating_state, /controller/injection_state: tare and gain stay while the needle is led in contact
/// Out: /force_sensor/measured_cf (WrenchStamped at the tip in `needle_tip`, tared and calibrated)
///      /force_sensor/raw_cf (WrenchStamped in the sensor's frame; a two-axis sensor has no torque)
///      both with stamp 0 without a valid input, while the sensor repeats one reading, and from an overload to a reset
/// Services: ~tare, ~reset (std_srvs/Trigger), ~calibrate (CalibrateForce; two-axis sensors). A
///      service only starts an average; its outcome is on /diagnostics.
/// File: tare and gain of a two-axis sensor, written after each change and read at the start
///
/// Parameters: config/force_sensor.yaml
class ForceSensorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError, also when tf does not have the sensor's frame in time
  explicit ForceSensorNode(Bus& bus);

 private:
  struct Parameters {
    std::string source = "simulated";
    double rate = 1000;
    double input_timeout = 0.05;
    double averaging = 0.5;
    bool quiet = false;  ///< its noise is below its step, so that it may repeat a reading
    std::string frame = "force_sensor";
    double frame_timeout = 60;
    std::string file;  ///< of tare and gain; empty: not kept
    ForceSensorConfig simulated;
    SerialPortConfig port;
    VoltReadingConfig voltages;
    Eigen::Vector2d overload{2e-3, 4e-3};  ///< N, of a real sensor, (axial, lateral)
    static Parameters read(const Bus& bus);
  };

  std::unique_ptr<ForceSource> makeSource();
  void advertiseServices();
  void step(const Cycle::Tick& tick);
  void publishInvalid(const Cycle::Tick& tick);
  geometry_msgs::WrenchStamped atTip(const Eigen::VectorXd& force, const ros::Time& stamp) const;
  void calibrate(const cell_microinjection::CalibrateForce::Request& request,
                 cell_microinjection::CalibrateForce::Response& response);
  std::string invalidReason() const;
  std::string act(const cell_microinjection::CalibrateForce::Request& request);
  std::string notReadyReason() const;
  bool inUse() const;  ///< the force must not jump now
  std::string inUseReason() const;
  void watchController();
  void keepCalibration();
  void reportOutcome();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  Eigen::Isometry3d tip_from_sensor_ = Eigen::Isometry3d::Identity();
  Cycle cycle_;
  std::unique_ptr<ForceSource> source_;
  ForceReadout readout_;
  Repetition<Eigen::VectorXd> readings_;  ///< as the source gives them, exposed to readings
  Output<geometry_msgs::WrenchStamped>& measured_;
  Output<geometry_msgs::WrenchStamped>& raw_;
  std::optional<BackgroundFile> file_;
  unsigned kept_changes_ = 0;     ///< of the readout, that are in the file
  std::string reported_outcome_;  ///< of the readout
  BusHandle tare_, calibrate_, reset_;
  std::string controller_state_, injection_state_;  ///< empty: there is no controller
  std::vector<Subscription> controller_;
};

}  // namespace microinjection
