#pragma once

#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "cell_microinjection/CalibrateForce.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/stamps.h"
#include "virtual_session.h"

namespace microinjection {

constexpr char kSensorStatus[] = "force_sensor: sensor";

/// The simulated force sensor alone. The test, as the node "world", has the needle 25 um above the cell's centre, and
/// the force on it.
class SensorBench {
 public:
  using Wrench = geometry_msgs::WrenchStamped;
  using Calibrate = cell_microinjection::CalibrateForce;

  explicit SensorBench(double diagnostic_period = 0.1)
      : path(session.folder() / "sensor.yaml"),
        measured(session.world().hear<Wrench>("force_sensor/measured_cf")),
        raw(session.world().hear<Wrench>("force_sensor/raw_cf")) {
    session.world().repeat<geometry_msgs::PoseStamped>("needle/measured_cp", [this] { return needle; });
    session.world().repeat<Wrench>("cell/predicted_cf", [this] { return force; });
    YAML::Node parameters;
    parameters["diagnostic_period"] = diagnostic_period;
    parameters["file"] = path;
    session.add("force_sensor", YAML::Dump(parameters));
    session.run(0.02);
  }

  /// Under this force (N, in `world`) from now on.
  void load(double x, double y, double z, double seconds) {
    force = wrenchMessage(x, y, z);
    session.run(seconds);
  }
  bool valid() const { return measured.newest() && !measured.newest()->header.stamp.isZero(); }
  /// N, (lateral, axial), averaged against the noise.
  Eigen::Vector2d mean(const Probe<Wrench>& readings) {
    session.run(0.02);
    const std::size_t first = readings.count();
    session.run(0.2);
    Eigen::Vector2d total(0, 0);
    for (std::size_t i = first; i < readings.count(); ++i)
      total += Eigen::Vector2d(readings.all()[i]->wrench.force.x, readings.all()[i]->wrench.force.z);
    return total / static_cast<double>(readings.count() - first);
  }

  std_srvs::TriggerResponse trigger(const std::string& service) {
    return session.call<std_srvs::Trigger>("force_sensor/" + service);
  }
  void tare() {
    session.run(0.02);
    const auto answer = trigger("tare");
    EXPECT_TRUE(answer.success) << answer.message;
    session.run(0.6);  // the average takes 0.5 s
  }
  /// `lateral`, `axial`: N, of the force that is known.
  Calibrate::Response calibrate(int action, double lateral = 0, double axial = 0) {
    Calibrate::Request request;
    request.action = static_cast<std::uint8_t>(action);
    request.force.x = lateral;
    request.force.z = axial;
    return session.call<Calibrate>("force_sensor/calibrate", request);
  }

  VirtualSession session;
  const std::string path;  ///< of tare and gain
  geometry_msgs::PoseStamped needle = poseMessage(0, 0, 25e-6);
  std::optional<Wrench> force = wrenchMessage(0, 0, 0);
  Probe<Wrench>&measured, &raw;
};

}  // namespace microinjection
