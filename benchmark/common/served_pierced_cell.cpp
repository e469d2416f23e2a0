#include "benchmark/common/served_pierced_cell.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "cell/family/family_cell.h"
#include "cell/model/solved_branch.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kTimeStep = 1e-3;     // s
constexpr double kShareAtOnset = 0.8;  // of the loop's force and depth
constexpr double kStrokes = 0.1;       // s, between two
constexpr double kRise = 50e-6;        // s, of a stroke

Scene sceneOf(const PiercedCase& of) {
  Scene scene = loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml");
  scene.cell.puncture.layers.front().toughness = of.toughness;
  scene.cell.puncture.layers.front().barrier = of.barrier;
  scene.cell.puncture.shaft.coefficient = of.coefficient;
  if (of.more) of.more(scene);
  return scene;
}

PiercedBranch::Onset withoutBarrier(const Scene& scene) {
  Scene weaker = scene;
  weaker.cell.puncture.layers.front().barrier = 0;
  return storedPiercedBranch(weaker).onset().value();
}

TipForce validForce(PuncturableCell& cell, const Vector3d& tip, double time) {
  const TipForce force = cell.step(tip, Vector3d::UnitZ(), time);
  if (!force.valid) throw std::runtime_error("the pierced cell has no force: " + cell.invalidReason());
  return force;
}

/// A stroke in the step that ends at `time`, after one of `period`.
void strikeWhenDue(PuncturableCell& cell, double stroke, double time, double period) {
  if (stroke > 0 && std::floor(time / kStrokes) > std::floor((time - period) / kStrokes)) cell.strike({stroke, kRise});
}

/// A needle and the energy that it has given.
struct WayInCell {
  PuncturableCell* cell;
  WaysOfNeedle* result;
  double period, stroke;                                      // s, m
  Vector3d tip = Vector3d::Zero(), force = Vector3d::Zero();  // m, N
  double time = 0, given = 0;                                 // s, J

  void moveTo(const Vector3d& goal, double speed) {
    const int steps = std::max(1, static_cast<int>(std::lround((goal - tip).norm() / (speed * period))));
    const Vector3d move = (goal - tip) / steps;
    for (int i = 0; i < steps; ++i) {
      const Vector3d before = force;
      tip += move;
      time += period;
      strikeWhenDue(*cell, stroke, time, period);
      force = validForce(*cell, tip, time).force;
      given -= 0.5 * (before + force).dot(move);
      result->least_energy = std::min(result->least_energy, given);
      result->largest_given = std::max(result->largest_given, given);
    }
  }
  void rest(double duration) {
    for (int i = 0; i < std::lround(duration / period); ++i) {
      time += period;
      strikeWhenDue(*cell, stroke, time, period);
      force = validForce(*cell, tip, time).force;
    }
  }
};

}  // namespace

ServedPiercedCell::ServedPiercedCell(const PiercedCase& of)
    : scene_(sceneOf(of)), branch_(storedPiercedBranch(scene_)), stroke_(of.stroke) {
  std::string refusal;
  const auto member = findFamilyCell(MICROINJECTION_SOURCE_DIR "/config/families", scene_, refusal);
  if (!member) throw std::runtime_error("no family has the pierced cell: " + refusal);
  data_ = member->data;
  onset_ = branch_->onset() ? *branch_->onset() : withoutBarrier(scene_);
}

std::unique_ptr<PuncturableCell> ServedPiercedCell::make() const {
  return std::make_unique<PuncturableCell>(scene_, std::make_unique<SurrogateCellModel>(scene_, data_), std::nullopt,
                                           branch_);
}

TeleoperationLoop::Touched ServedPiercedCell::makeTouched(double stiffness, double pressed) const {
  const double scale = onset_.depth / (kShareAtOnset * pressed / stiffness);
  const double gain = kShareAtOnset * pressed / onset_.force;
  const std::shared_ptr<PuncturableCell> cell = make();
  return [cell, scale, gain, radius = radius(), stroke = stroke_, time = 0.0](double needle) mutable {
    time += kTimeStep;
    strikeWhenDue(*cell, stroke, time, kTimeStep);
    const TipForce force = cell->step({0, 0, radius + scale * needle}, Vector3d::UnitZ(), time);
    return force.valid ? gain * force.force.z() : 0;
  };
}

WaysOfNeedle driveRandomWays(const ServedPiercedCell& served, int ways, unsigned seed, double fastest, double period) {
  constexpr double kAbove = 1e-6, kDeepest = 3;  // m, of the onset's depth
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WaysOfNeedle result;
  std::unique_ptr<PuncturableCell> cell;
  WayInCell way{};
  for (int i = 0; i < ways; ++i) {
    const bool first = i % 2 == 0;
    if (first) cell = served.make();
    way = {cell.get(), &result, period, served.stroke()};
    if (!first) way.time = 1e3;
    const auto beside = [&] { return between(-1, 1) * served.tipRadius(); };
    double x = beside();
    const double out = served.radius() + kAbove;
    way.tip = {x, 0, out};
    way.rest(0.1);
    for (int leg = std::uniform_int_distribution<int>(2, 8)(random); leg >= 0; --leg) {
      const double depth = leg == 0 ? -kAbove : between(0, kDeepest) * served.onset().depth;
      if (way.cell->insertion().inside && leg > 0) x = beside();
      way.moveTo({x, 0, served.radius() - depth}, fastest * std::pow(10, between(-2.5, 0)));
      way.rest(between(0, 1) < 0.3 ? between(0, 0.02) : 0);
    }
    way.rest(0.1);
    ++result.ways;
    result.pierced += first && way.cell->insertion().layers_punctured > 0;
  }
  return result;
}

}  // namespace microinjection
