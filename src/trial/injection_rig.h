#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <random>

#include "hardware/injector/injector_model.h"
#include "hardware/injector/pipette_flow.h"
#include "hardware/manipulator/micromanipulator.h"
#include "hardware/manipulator/simulated_manipulator.h"
#include "hardware/sensor/force_sensor.h"
#include "operation/control/injection_controller.h"
#include "trial/scaled_cell.h"

namespace microinjection {

/// A whole rig in virtual time, 1 kHz, without ROS: the controller sees what the simulated
/// micromanipulator measures and what the virtual force sensor reads of the cell's force, one step
/// old, and moves the needle and the injector.
class InjectionRig {
 public:
  /// What goes wrong, `begin` (s) after the start.
  struct Disturbance {
    enum class Kind {
      kNone,
      kForceLost,
      kNeedleLost,
      kRigStands,  ///< set-points are lost for 3 s
      kInjectorDead,
      kSensorFrozen,
      kSensorOffset,  ///< size: N, axial
      kSensorDrift,   ///< size: N/s, axial
      kCommandsLate,  ///< size: s
      kNeedleDrift    ///< size: m/s along z, of the true tip: the device does not measure it
    };
    Kind kind = Kind::kNone;
    double begin = 0;
    double size = 0;
  };
  struct Config {
    Disturbance disturbance;
    InjectionControllerConfig controller;
    std::optional<ExpectedPuncture> expected;  ///< by the controller
    ForceSensorConfig sensor;
    SimulatedManipulatorConfig manipulator;
    InjectorModelConfig injector;
    /// The image of the interface in the bore, 50 Hz.
    struct InterfaceImage {
      bool seen = false;
      double noise = 0.15e-6;  ///< m, standard deviation
      double latency = 0.02;   ///< s, until the controller has it
      unsigned seed = 1;
    } interface;
    Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< m, of the tip
  };
  static constexpr double kStep = 1e-3;  ///< s

  /// @param cell  outlives this
  InjectionRig(const Config& config, const ManipulatorGeometry& geometry, ScaledCell& cell);

  /// Until the controller's injection is over, or `limit` (s).
  void run(double limit);
  /// @param target  m, where a hand wants the tip, for a controller of the mode manual
  void step(const std::optional<Eigen::Vector3d>& target = std::nullopt);
  /// A command to the controller. @returns why it is refused; empty: it is not
  std::string command(const std::string& command) { return controller_.command(command); }
  double time() const { return time_ - began_; }                 ///< s, since the start
  double volume() const { return injector_.reading().volume; }   ///< m^3, delivered
  const Eigen::Vector2d& reading() const { return reading_; }    ///< N, of the sensor: axial, lateral
  const Eigen::Vector3d& measured() const { return measured_; }  ///< m, the tip as the device tells it

  // What truly happened.
  struct Truth {
    double peak_force = 0;                 ///< N, along the pipette
    double max_depth = 0;                  ///< m past where the tip touched
    std::optional<double> puncture_depth;  ///< m, same, where the last membrane failed
    std::optional<double> zona_depth;      ///< m, same, where the first one failed
    int punctures = 0;
    double latency = 0;              ///< s, longest from a membrane's failure to the controller's word
    int false_detections = 0;        ///< touches without contact, and punctures without a failure
    int unfelt = 0;                  ///< failures that the controller has not felt
    bool valid = true;               ///< the cell's force, always
    double depth = 0;                ///< m, now
    double force = 0;                ///< N, along the pipette, now
    bool in_cell = false;            ///< in contact or through a membrane, now
    bool broken_by_suction = false;  ///< a membrane has failed while the needle drew it in
    /// s after that failure, when the suction ended; empty: it has not
    std::optional<double> suction_latency;
    double drawn_too_much = 0;  ///< m^3, into the bore since then
  };
  const Truth& truth() const { return truth_; }
  const InjectionController& controller() const { return controller_; }
  Eigen::Vector3d tip() const;  ///< m, where it truly is
  /// Rests: 0.2 s later (a second after a rig that stood still goes again) the tip stays where it
  /// is for half a second, and the injector is off.
  bool holds();

 private:
  double sinceDisturbance() const { return time_ - began_ - disturbance_.begin; }  ///< s
  bool isIn(Disturbance::Kind kind) const;
  void read(const Eigen::Vector3d& force);
  /// The set-point that reaches the micromanipulator now.
  std::optional<Eigen::Vector3d> arriving(const std::optional<Eigen::Vector3d>& setpoint);
  void monitor(const Eigen::Vector3d& force, const Eigen::Vector3d& tip);
  void monitorSuction(bool drawing);
  std::optional<InterfaceReading> interface();
  void command(const std::optional<PulseGoal>& pulse);
  void receive(InjectionState before, int punctures_before);

  ManipulatorGeometry geometry_;
  SimulatedManipulator device_;
  Micromanipulator manipulator_;
  ForceSensor sensor_;
  InjectorModel injector_;
  InjectionController controller_;
  ScaledCell* cell_;
  Eigen::Vector2d reading_ = Eigen::Vector2d::Zero();   ///< N
  Eigen::Vector3d measured_ = Eigen::Vector3d::Zero();  ///< m
  Disturbance disturbance_;
  std::deque<std::optional<Eigen::Vector3d>> setpoints_;  ///< m, on their way, the newest last
  std::optional<ExpectedPuncture> expected_;
  double began_ = 0;  ///< s
  double time_ = 0;   ///< s
  std::uint64_t pulses_ = 0;
  bool pulsing_ = false;
  std::optional<double> touch_height_;  ///< m
  int felt_ = 0;
  double failed_at_ = 0;  ///< s
  PipetteFlow flow_;
  Config::InterfaceImage image_;
  std::mt19937 random_;
  struct Frame {
    double time, position;  ///< s, m
  };
  std::deque<Frame> frames_;               ///< on their way, the newest last
  double next_frame_ = 0;                  ///< s
  std::optional<double> seen_;             ///< m, the last interface that the controller has seen
  std::optional<double> volume_at_break_;  ///< m^3, of the cell in the bore, when a membrane failed under suction
  Truth truth_;
};

}  // namespace microinjection
