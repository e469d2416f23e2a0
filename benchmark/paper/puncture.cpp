// Section V.A of the paper: the force behind its puncture, as it follows from mechanics.

#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

#include "benchmark/bench_main.h"
#include "cell/model/solved_branch.h"

namespace microinjection {
namespace {

constexpr char kPuncturedScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_stiffening.yaml";
constexpr double kWayStep = 0.25e-6;  ///< m
constexpr double kWayOn = 2.5e-6;     ///< m, behind the onset: deeper is not solved

std::string rowOf(const char* way, double depth, double force, double length) {
  char text[120];
  std::snprintf(text, sizeof text, "%s,%.6g,%.6g,%.6g\n", way, depth, force, length);
  return text;
}

/// Depth, force and hole on the way in without and with the puncture, and out of the hole that has been made; the long
/// hole's forces, with its radius.
std::string waysTable() {
  const Scene scene = loadScene(kPuncturedScene);
  const PiercedBranch branch = solvePiercedBranch(scene);
  if (!branch.onset()) throw std::runtime_error("no depth that is solved pierces the cell");
  const PiercedBranch::Onset onset = *branch.onset();
  std::string text = "way,depth_m,force_N,hole_m\n";
  double depth = 0, length = onset.length;
  for (; depth < onset.depth + kWayOn; depth += kWayStep) text += rowOf("whole", depth, branch.whole(depth).force, 0);
  text += rowOf("onset", onset.depth, onset.force, 0);
  for (depth = onset.depth; depth < onset.depth + kWayOn; depth += kWayStep) {
    length = branch.grown(depth, length);
    text += rowOf("in", depth, branch.at(depth, length).force, length);
  }
  const double tip = scene.needle.tip.radius;
  const double emptied = length + branch.holes().front().knots.front().beyond;
  for (; depth > emptied; depth -= kWayStep) text += rowOf("out", depth, branch.at(depth, length).force, length);
  const SteadyPenetration steady = steadyPenetration(scene);
  text += rowOf("steady_in", 0, steady.force_in * tip * tip, steady.hole_radius * tip);
  text += rowOf("steady_out", 0, steady.force_out * tip * tip, steady.hole_radius * tip);
  std::cout << text;
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "puncture: force of the paper's puncture and behind it, by mechanics",
                                   microinjection::waysTable);
}
