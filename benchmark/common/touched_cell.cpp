#include "benchmark/common/touched_cell.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "benchmark/common/suction_hold.h"
#include "cell/choice/make_cell_model.h"
#include "cell/model/scene.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 1e-3;  // s
constexpr double kDeep = 0.2;     // over the cell's radius

Scene heldCellScene() {
  Scene scene;
  scene.cell.layers[0].outer_radius = 40e-6;
  scene.cell.material().model = "neo_hookean";
  scene.cell.material().young_modulus = 5e3;
  scene.cell.material().poisson_ratio = 0.49;
  scene.holding_pipette.mouth = Scene::Mouth{12e-6, 26.4e-6, 2.4e-6, -500, {"sliding", 0, 0, 0}};
  scene.holding_pipette.contact_radius = 14.4e-6;
  scene.needle.tip = {"hemisphere", 4e-6, 0};
  return scene;
}

Scene adheringCellScene() {
  Scene scene = heldCellScene();
  scene.holding_pipette.mouth.reset();
  scene.needle.contact = {"sliding", 0.2, 3e-4, 0.3e-6};
  return scene;
}

/// Depth below the first touch (m) to force on the needle along its way out (N).
using Pressed = std::function<double(double)>;

/// As a session serves it.
Pressed servedCell(const Scene& scene) {
  CellModelConfig config;
  config.families = std::string(MICROINJECTION_SOURCE_DIR) + "/config/families";
  const std::shared_ptr<CellModel> model = makeCellModel(scene, "surrogate", config, "the touched cell").cell;
  return [model, radius = scene.radius(), time = 0.0](double depth) mutable {
    time += kPeriod;
    return model->step({0, 0, radius - depth}, Vector3d::UnitZ(), time).force.z();
  };
}

/// @param out the needle's way out, unit. @param beside m, of the needle's line from the cell's centre
Pressed movingCell(CellMotion motion, CellMotionInput input, const Vector3d& out, const Vector3d& beside) {
  const double reach = motion.config().radius + kHeldTip;
  const double along_line = std::sqrt(reach * reach - beside.squaredNorm()) - kHeldTip;
  const Vector3d touch = motion.state().position + beside + along_line * out;
  return [motion, input, out, touch](double depth) mutable {
    input.needle = along(out, touch - depth * out);
    return -motion.step(kPeriod, input).needle.force.dot(out);
  };
}

Pressed slidingCell() {
  CellMotionConfig config = withoutDish();
  config.density_difference = 0;
  config.friction.lip = 0.05;
  config.friction.needle = 2;
  CellMotionInput input;
  CellMotion motion = placedBeforeMouth(config, input, -2000);
  for (int i = 0; i < 50; ++i) motion.step(kPeriod, input);
  return movingCell(std::move(motion), input, Vector3d::UnitX(), config.radius / 2 * Vector3d::UnitY());
}

Pressed looseCell() {
  const CellMotionConfig config;
  CellMotion motion(config, {}, RoundedTip(kHeldTip, kHeldTip));
  motion.place({0, 0, config.radius}, Eigen::Quaterniond::Identity(), {});
  return movingCell(std::move(motion), {}, Vector3d::UnitZ(), 0.3 * config.radius * Vector3d::UnitX());
}

/// N, of Hertz's contact of the moving cells with their needle.
double hertzForce(double depth) {
  const CellMotionConfig config;
  const double curvature = 1 / (1 / config.radius + 1 / kHeldTip);
  return 4.0 / 3 * config.contactModulus() * std::sqrt(curvature) * std::pow(depth, 1.5);
}

}  // namespace

std::string name(TouchedCell cell) {
  switch (cell) {
    case TouchedCell::kAdhering:
      return "adhering";
    case TouchedCell::kHeld:
      return "held";
    case TouchedCell::kSliding:
      return "sliding";
    case TouchedCell::kLoose:
      return "loose";
  }
  throw std::invalid_argument("no such cell");
}

TeleoperationLoop::Touched makeTouchedCell(TouchedCell cell, double stiffness, double pressed) {
  const double deep = kDeep * 40e-6, scale = deep / (pressed / stiffness);
  const bool moves = cell == TouchedCell::kSliding || cell == TouchedCell::kLoose;
  const Scene scene = cell == TouchedCell::kAdhering ? adheringCellScene() : heldCellScene();
  const Pressed force = cell == TouchedCell::kSliding ? slidingCell()
                        : cell == TouchedCell::kLoose ? looseCell()
                                                      : servedCell(scene);
  const double gain = pressed / (moves ? hertzForce(deep) : servedCell(scene)(deep));
  return [force, scale, gain](double needle) mutable { return gain * force(-scale * needle); };
}

}  // namespace microinjection
