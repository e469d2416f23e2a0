// Sensor and prediction as each other's witnesses: how far they differ while all is right, and how soon a fault is
// caught.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "cell/choice/make_cell_model.h"
#include "hardware/sensor/force_sensor.h"
#include "operation/control/injection_controller.h"
#include "session/session_plan.h"

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;      ///< s
constexpr double kRig = 5e-3;       ///< s, time constant of the needle behind its set-point
constexpr double kGap = 10e-6;      ///< m, of the tip above the cell at the start, for a cell of 56 um
constexpr double kLongest = 30;     ///< s
constexpr double kStrained = 1.15;  ///< the descent ends before the membrane fails: force and indentation times this

/// What differs between sensor and prediction in one descent.
struct Descent {
  double height = 0;     ///< m, of the cell above its place in the scene
  double stiffness = 1;  ///< of the cell, over that of the scene
  double lag = 0;        ///< s, of the sensor's readings
  int seed = 1;
  std::string fault;  ///< of the sensor: zero, frozen, late, gain, sign; empty: none
  bool acts_on_sensor = false;
};

/// What a descent has shown.
struct Course {
  double depth = 0, force = 0;  ///< m and N past the touch of one, when the other felt none
  double ratio = 1;             ///< largest of the two, past the force that is allowed
  std::optional<double> held;   ///< m past the true touch, where the needle was held
  double after = 0;             ///< s since then
  bool pulse = false;
};

/// A scene of config/cells as a session has it: model and controller.
class WitnessedCell {
 public:
  /// @throws ConfigError when no data serve the scene.
  WitnessedCell(const std::string& path, const std::string& name)
      : scene_(loadScene(path)), sensor_cell_(model(path)), predicted_cell_(model(path)) {
    const Session session = Session::load("default", {"cell:=" + name, "hand.device:=none"}, MICROINJECTION_SOURCE_DIR);
    const SessionPlan plan = planOf(session, SessionClock::kVirtual);
    ConfigReader reader(plan.node("injection_controller")->parameters, name);
    controller_ = InjectionControllerConfig::read(reader);
    length_ = scene_.radius() / 28e-6;
  }

  const InjectionControllerConfig& controller() const { return controller_; }
  double length() const { return length_; }  ///< of the cell, over that of 56 um

  /// `guarded`: the witnesses hold the needle.
  Course run(const Descent& of, bool guarded);

 private:
  std::unique_ptr<CellModel> model(const std::string& path) const {
    CellModelConfig config;
    config.families = MICROINJECTION_SOURCE_DIR "/config/families";
    return makeCellModel(scene_, "surrogate", config, path).cell;
  }
  bool membraneHolds(const CellModel& cell, double push) const {
    if (scene_.cell.puncture.layers.empty() || !cell.contact()) return true;
    return !scene_.cell.puncture.layers.front().fails(kStrained * push, kStrained * cell.contact()->indentation,
                                                      scene_.needle.tip.radius);
  }

  Scene scene_;
  std::unique_ptr<CellModel> sensor_cell_, predicted_cell_;
  InjectionControllerConfig controller_;
  double length_ = 1;
};

/// The sensor's readings, with its lag and its fault.
class WitnessSensor {
 public:
  explicit WitnessSensor(const Descent& of)
      : of_(of), lag_(of.fault == "late" ? 0.5 : of.lag), sensor_(seeded(of.seed)) {
    for (double time = 0; time < lag_; time += kStep) readings_.push_back(sensor_.sample({0, 0}, kStep));
  }

  /// N, (axial, lateral) in `world`. `touched`: the cell, now or before.
  Eigen::Vector3d read(const Eigen::Vector3d& force, bool touched) {
    const Eigen::Vector2d now = sensor_.sample({force.z(), force.x()}, kStep);
    readings_.push_back(now);
    if (static_cast<double>(readings_.size()) * kStep > lag_ + 1.5 * kStep) readings_.pop_front();
    Eigen::Vector2d reading = readings_.front();
    if (of_.fault == "zero") reading.setZero();
    if (of_.fault == "gain") reading *= 1000;
    if (of_.fault == "sign") reading *= -1;
    if (of_.fault == "frozen" && touched) reading = frozen_;
    frozen_ = reading;
    return {reading[1], 0, reading[0]};
  }

 private:
  static ForceSensorConfig seeded(int seed) {
    ForceSensorConfig config;
    config.seed = seed;
    return config;
  }

  Descent of_;
  double lag_;  ///< s
  ForceSensor sensor_;
  std::deque<Eigen::Vector2d> readings_;
  Eigen::Vector2d frozen_ = Eigen::Vector2d::Zero();
};

/// A monitor that forgets a touch that was noise, as ForceWitness does.
class TouchMonitor {
 public:
  explicit TouchMonitor(const DetectionConfig& config) : monitor_(config) {}

  void step(const Eigen::Vector3d& tip, const Eigen::Vector3d& force) {
    monitor_.step(tip, Eigen::Vector3d::UnitZ(), force);
    if (monitor_.confirmed() && !*monitor_.confirmed()) monitor_.rearm();
  }
  const NeedleMonitor& operator*() const { return monitor_; }
  const NeedleMonitor* operator->() const { return &monitor_; }

 private:
  NeedleMonitor monitor_;
};

void compare(const TouchMonitor& one, const TouchMonitor& other, const WitnessConfig& allowed,
             const Eigen::Vector3d& tip, Course& course) {
  if (!one->ready() || !other->ready() || !one->touched()) return;
  if (!other->touched()) {
    course.depth = std::max(course.depth, one->depthOf(tip, Eigen::Vector3d::UnitZ()));
    course.force = std::max(course.force, one->force());
  } else if (other->depthOf(tip, Eigen::Vector3d::UnitZ()) > allowed.depth && one->force() > allowed.force &&
             one->force() >= other->force()) {
    course.ratio = std::max(course.ratio, one->force() / std::max(other->force(), 1e-12));
  }
}

Course WitnessedCell::run(const Descent& of, bool guarded) {
  sensor_cell_->release();
  predicted_cell_->release();
  InjectionControllerConfig config = controller_;
  config.mode = "automatic";
  config.witness.measured = !of.acts_on_sensor;
  if (!guarded) config.witness.depth = config.witness.force = config.witness.ratio = 1e9;
  InjectionController controller(config);
  controller.adaptTo(1e-3, kRig);
  controller.command("enable");
  WitnessSensor sensor(of);
  TouchMonitor felt(config.detection), predicted(config.detection);
  const double top = scene_.radius() + std::max(0.0, of.height);
  Eigen::Vector3d tip(0, 0, top + length_ * kGap);
  std::optional<double> touch_height;  // m
  double touched_at = 0;               // s
  Course course;
  for (double time = kStep; time < kLongest; time += kStep) {
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    const TipForce true_force = sensor_cell_->step(tip - of.height * axis, axis, time);
    const TipForce model_force = predicted_cell_->step(tip, axis, time);
    if (!true_force.valid || !model_force.valid) break;
    if (!membraneHolds(*sensor_cell_, true_force.force.z()) || !membraneHolds(*predicted_cell_, model_force.force.z()))
      break;
    if (sensor_cell_->contact() && !touch_height) {
      touch_height = tip.z();
      touched_at = time;
    }
    const Eigen::Vector3d reading = sensor.read(of.stiffness * true_force.force, touch_height.has_value());
    felt.step(tip, reading);
    predicted.step(tip, model_force.force);
    compare(felt, predicted, controller_.witness, tip, course);
    compare(predicted, felt, controller_.witness, tip, course);
    InjectionController::Input input;
    input.needle = tip;
    input.force = of.acts_on_sensor ? reading : model_force.force;
    input.witness = of.acts_on_sensor ? model_force.force : reading;
    if (!of.acts_on_sensor) input.predicted_inside = false;
    const auto setpoint = controller.step(input, kStep);
    course.pulse = course.pulse || controller.pulse().has_value();
    const InjectionOutcome outcome = controller.result().outcome;
    const bool paused = controller.state() == OperatingState::kPaused;  // a sensor at fault before it sets out, too
    if (outcome != InjectionOutcome::kNone || paused) {
      if (outcome != InjectionOutcome::kGuard && !(outcome == InjectionOutcome::kNone && paused)) break;
      course.held = touch_height ? *touch_height - tip.z() : 0;
      course.after = touch_height ? time - touched_at : 0;
      break;
    }
    if (setpoint) tip += (*setpoint - tip) * (kStep / kRig);
  }
  return course;
}

double worst(std::vector<double> values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}
double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class WitnessTable {
 public:
  std::string rows() {
    table_.add(
        "scene,fault,acts_on,descents,depth_um,force_uN,ratio,allowed_depth_um,allowed_force_uN,allowed_ratio,held,"
        "median_held_um,worst_held_um,worst_after_s,pulses\n");
    std::vector<std::filesystem::path> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(MICROINJECTION_SOURCE_DIR "/config/cells"))
      scenes.push_back(entry.path());
    std::sort(scenes.begin(), scenes.end());
    for (const std::filesystem::path& path : scenes) {
      try {
        WitnessedCell cell(path.string(), path.stem().string());
        right(cell, path.stem().string());
        for (const char* fault : {"zero", "frozen", "late", "gain", "sign"}) wrong(cell, path.stem().string(), fault);
      } catch (const ConfigError& error) {
        std::fprintf(stderr, "witness: %s is left out: %s\n", path.stem().c_str(), error.what());
      }
    }
    return table_.text();
  }

 private:
  /// Heights that a scene misses a cell by, and its error of the modulus.
  static std::vector<Descent> descents(const WitnessedCell& cell) {
    std::vector<Descent> all;
    for (const double height : {-3e-6, 0.0, 3e-6}) {
      for (const double stiffness : {0.5, 1.0, 2.0}) {
        for (const double lag : {0.0, 0.02}) {
          Descent of;
          of.height = cell.length() * height;
          of.stiffness = stiffness;
          of.lag = lag;
          of.seed = static_cast<int>(all.size()) + 1;
          all.push_back(of);
        }
      }
    }
    return all;
  }

  void right(WitnessedCell& cell, const std::string& scene) {
    for (const bool acts_on_sensor : {false, true}) {
      std::vector<double> depth, force, ratio;
      int held = 0, pulses = 0;
      for (Descent of : descents(cell)) {
        of.acts_on_sensor = acts_on_sensor;
        const Course course = cell.run(of, false);
        depth.push_back(course.depth);
        force.push_back(course.force);
        ratio.push_back(course.ratio);
        held += cell.run(of, true).held.has_value();
        pulses += course.pulse;
      }
      const WitnessConfig& allowed = cell.controller().witness;
      char text[300];
      std::snprintf(text, sizeof text, "%s,none,%s,%zu,%.2f,%.3f,%.2f,%.2f,%.3f,%.2f,%d,,,,%d\n", scene.c_str(),
                    acts_on_sensor ? "measured" : "predicted", depth.size(), 1e6 * worst(depth), 1e6 * worst(force),
                    worst(ratio), 1e6 * allowed.depth, 1e6 * allowed.force, allowed.ratio, held, pulses);
      table_.add(text);
    }
  }

  void wrong(WitnessedCell& cell, const std::string& scene, const std::string& fault) {
    for (const bool acts_on_sensor : {false, true}) {
      std::vector<double> held, after;
      int pulses = 0, count = 0;
      for (Descent of : descents(cell)) {
        if (of.lag > 0) continue;
        of.acts_on_sensor = acts_on_sensor;
        of.fault = fault;
        const Course course = cell.run(of, true);
        ++count;
        pulses += course.pulse;
        if (!course.held) continue;
        held.push_back(*course.held);
        after.push_back(course.after);
      }
      char text[300];
      std::snprintf(text, sizeof text, "%s,%s,%s,%d,,,,,,,%zu,%.2f,%.2f,%.2f,%d\n", scene.c_str(), fault.c_str(),
                    acts_on_sensor ? "measured" : "predicted", count, held.size(), 1e6 * median(held),
                    1e6 * worst(held), worst(after), pulses);
      table_.add(text);
    }
  }

  PrintedTable table_;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "Sensor and prediction as each other's witnesses, over the prepared scenes of config/cells.",
      [] { return microinjection::WitnessTable().rows(); });
}
