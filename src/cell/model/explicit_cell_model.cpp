#include "cell/model/explicit_cell_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/errors.h"
#include "cell/mechanics/largest_frequency.h"

namespace microinjection {
namespace {

constexpr double kDensity = 1000;     // kg/m^3, Table I of the paper
constexpr double kShare = 0.5;        // of the step to the bound of the undeformed cell, which stiffens when pressed
constexpr double kLongestGap = 0.01;  // s, past which the dynamics leaves time out

void requireHomogeneous(const Scene& scene) {
  std::vector<std::string> errors = P1Cell::refusals(scene);
  if (scene.cell.layers.size() != 1) {
    errors.push_back("cell/layers: must be one (explicit dynamics is for a homogeneous cell)");
  } else {
    const std::string& model = scene.cell.layers.front().material.model;
    if (model != "st_venant_kirchhoff" && model != "linear") {
      errors.push_back("cell/material/model = " + model +
                       ": must be st_venant_kirchhoff or linear (explicit dynamics)");
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
}

}  // namespace

ExplicitCellModelConfig ExplicitCellModelConfig::read(ConfigReader& reader) {
  ExplicitCellModelConfig config;
  reader.number("time_step", config.time_step, Range::closed(1e-4, 1e-3));
  return config;
}

ExplicitCellModel::ExplicitCellModel(const Scene& scene, const ExplicitCellModelConfig& config) {
  requireHomogeneous(scene);
  cell_ = std::make_shared<const P1Cell>(scene);
  const MaterialConfig& material = scene.cell.layers.front().material;
  ExplicitStepConfig dynamics;
  dynamics.lame = Lame::from(material.young_modulus, material.poisson_ratio);
  may_invert_ = material.model == "linear";  // small strain has no inversion
  if (may_invert_) dynamics.force = ExplicitStepConfig::Force::kLinearTensors;
  const double stable = 2 * kShare / frequencyBound(cell_->mesh(), dynamics.lame, kDensity);
  mass_scale_ = std::max(1.0, std::pow(config.time_step / stable, 2));
  dynamics.density = mass_scale_ * kDensity;
  // Critical for a shear wave of two diameters.
  dynamics.damping = 2 * M_PI * std::sqrt(dynamics.lame.mu / dynamics.density) / scene.cell.diameter();
  dynamics.time_step = std::min(config.time_step, stable * std::sqrt(mass_scale_));
  dynamics.held = cell_->heldVertices();
  dynamics_.emplace(cell_->mesh(), dynamics);
  settling_time_ = 2 * std::log(100) / dynamics.damping;
  negligible_energy_ = 1e-6 * dynamics.lame.mu * std::pow(scene.needle.tip.radius, 3);
  invalid_reason_.reserve(200);
  drawn_.displacement.resize(cell_->surface().vertices.size());
}

std::string ExplicitCellModel::description() const {
  char text[200];
  std::snprintf(
      text, sizeof(text),
      "; central differences with the cell's mass times %.3g: the force also lags, and settles in some %.2g s",
      mass_scale_, settling_time_);
  return cell_->description() + text;
}

TipForce ExplicitCellModel::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  invalid_reason_.clear();
  const bool finite = tip.allFinite() && axis.allFinite() && std::isfinite(time);
  const TipForce force = finite ? computeForce(tip, axis, time) : invalidForce("the needle's pose is not finite");
  writeShape();
  return force;
}

TipForce ExplicitCellModel::computeForce(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  if (!contact_) {
    const auto touch = cell_->touch(tip, axis, hint_);
    if (touch && !cell_->isClear(tip, axis, *touch)) engage(*touch, axis);
  }
  if (contact_) {
    contact_->displacement = tip - contact_->contact_point;
    contact_->indentation = -contact_->displacement.dot(axis);
  }
  advance(contact_ ? contact_->displacement : Eigen::Vector3d::Zero(), time);
  unstable_ = unstable_ || !isStable();
  inverted_ = !may_invert_ && dynamics_->hasInvertedElement();
  if (!contact_) {
    if (unstable_ || inverted_) restore();
    return {};
  }
  const double push = dynamics_->force().dot(axis);
  if ((defect() != nullptr || push <= 0) && cell_->isClear(tip, axis, contact_->contact_point)) {
    unstable_ || inverted_ ? restore() : disengage();
    return {};
  }
  if (defect() != nullptr) return invalidForce(defect());
  if (push < 0) return {};  // there is no adhesion
  return {true, dynamics_->force()};
}

void ExplicitCellModel::engage(const Eigen::Vector3d& touch, const Eigen::Vector3d& axis) {
  const TipPatch patch = cell_->contactAt(snapToNeedleLine(cell_->scene().needle, touch), axis).patch;
  const std::vector<int>& held = cell_->heldVertices();
  const auto is_held = [&](int vertex) { return std::find(held.begin(), held.end(), vertex) != held.end(); };
  touches_held_ = std::any_of(patch.vertices.begin(), patch.vertices.end(), is_held);
  if (!touches_held_) dynamics_->setTip(patch.vertices);
  drawn_.contact_vertices = cell_->onSurface(patch);
  contact_ = Contact{};
  contact_->contact_point = touch;
  applied_.setZero();
  last_move_.setZero();
}

/// Each step's force is that at its start, so that the work of a move is known one step later.
void ExplicitCellModel::advance(const Eigen::Vector3d& displacement, double time) {
  if (!time_ || time < *time_) time_ = time;
  time_ = std::max(*time_, time - kLongestGap);
  const int count = static_cast<int>((time - *time_) / dynamics_->timeStep() + 1e-6);
  *time_ += count * dynamics_->timeStep();
  if (unstable_) return;
  const Eigen::Vector3d move = count > 0 ? Eigen::Vector3d((displacement - applied_) / count) : Eigen::Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    applied_ += move;
    dynamics_->step(applied_);
    work_ -= dynamics_->force().dot(last_move_ + move) / 2;
    last_move_ = move;
  }
}

/// No motion has more energy than the needle has put in; unstable steps give it ever more.
bool ExplicitCellModel::isStable() const {
  return dynamics_->kineticEnergy() < 2 * std::max(0.0, work_) + negligible_energy_;
}

/// Null where the force is valid.
const char* ExplicitCellModel::defect() const {
  if (touches_held_) return "the tip touches what the holding pipette holds";
  if (unstable_) return "the explicit time steps are unstable at this indentation; withdraw the needle";
  if (inverted_) return "an element is inverted: the needle is too deep or too fast; withdraw it";
  return nullptr;
}

void ExplicitCellModel::release() {
  restore();
  writeShape();
}

void ExplicitCellModel::disengage() {
  contact_.reset();
  drawn_.contact_vertices.clear();
  invalid_reason_.clear();
  touches_held_ = false;
  dynamics_->setTip({});
}

void ExplicitCellModel::restore() {
  disengage();
  dynamics_->reset();
  work_ = 0;
  unstable_ = inverted_ = false;
}

TipForce ExplicitCellModel::invalidForce(const char* reason) {
  invalid_reason_ = reason;
  return {false, Eigen::Vector3d::Zero()};
}

void ExplicitCellModel::writeShape() {
  const SurfaceMesh& surface = cell_->surface();
  const std::vector<double>& positions = dynamics_->positions();
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    drawn_.displacement[i] = Eigen::Vector3d::Map(&positions[3 * surface.mesh_vertices[i]]) - surface.vertices[i];
    if (unstable_) drawn_.displacement[i].setZero();
  }
  shape_.write(drawn_);
}

CellModel::DeformedSurface ExplicitCellModel::deformedSurface() {
  shape_.update();
  const Shape& shape = shape_.value();
  DeformedSurface picture;
  picture.at_rest = cell_->surface().vertices;
  picture.vertices = picture.at_rest;
  picture.displacement.resize(picture.vertices.size(), 0);
  for (std::size_t i = 0; i < shape.displacement.size(); ++i) {
    picture.vertices[i] += shape.displacement[i];
    picture.displacement[i] = shape.displacement[i].norm();
  }
  picture.contact_vertices = shape.contact_vertices;
  return picture;
}

}  // namespace microinjection
