#pragma once

#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "fault_session.h"

namespace microinjection {

/// A virtual hand presses the needle into a live cell and takes it out again.
class HandSession : public FaultSession {
 public:
  struct Options {
    bool linked = false;               ///< packets between hand and rig
    bool sensor = false;               ///< there is a force sensor
    bool injector = false;             ///< there is one
    std::string source = "predicted";  ///< of the force
  };
  explicit HandSession(const Options& options) : FaultSession(overrides(options)) {
    const std::string motion = session().folder() / "motion.csv";
    writeMotion(motion);
    session().add("virtual_hand", "{start_delay: 0.2, motion: " + motion + "}");
    session().start();
  }

  /// s, by which the force may end before the time-out when the hand is struck: of a killed process the connection ends
  /// at once, which the bridge looks at each 50 ms.
  static double sooner(NodeFault fault) { return fault == NodeFault::kKill ? 0.05 : 0; }

 private:
  static std::vector<std::string> overrides(const Options& options) {
    return {"cell:=" + testFile("scenes/coarse_oocyte.yaml"),
            "model:=live",
            "overrides:={rig: {start_height: 32e-6}}",
            "display.markers:=false",
            std::string("sensor.source:=") + (options.sensor ? "simulated" : "none"),
            std::string("injector:=") + (options.injector ? "simulated" : "none"),
            std::string("link.scheme:=") + (options.linked ? "wave" : "none"),
            "force.controller:=" + options.source,
            "force.hand:=" + options.source};
  }
  static void writeMotion(const std::string& path) {
    // Seconds, where the hand gets to (m of the needle), phase.
    const std::vector<std::tuple<double, double, std::string>> motion = {
        {0.02, 0, "rest"},     {0.15, -3e-6, "approach"}, {0.3, -8e-6, "indent"},
        {0.35, -8e-6, "hold"}, {0.6, -3e-6, "withdraw"},  {0.3, -3e-6, "rest"}};
    std::ofstream file(path);
    file.precision(9);
    file << "time_s,x_m,y_m,z_m,clutch,phase\n";
    double time = 0, z = 0;
    for (const auto& [duration, goal, phase] : motion) {
      file << time << ",0,0," << 1e3 * z << ",0," << phase << '\n';
      file << time + duration - 1e-6 << ",0,0," << 1e3 * goal << ",0," << phase << '\n';
      time += duration;
      z = goal;
    }
  }
};

}  // namespace microinjection
