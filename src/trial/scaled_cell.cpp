#include "trial/scaled_cell.h"

#include <utility>

#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

/// The same membranes on the surrogate cell: lengths are smaller by `length`, forces by `force`.
PunctureConfig onPrepared(PunctureConfig puncture, double length, double force) {
  for (auto& layer : puncture.layers) {
    layer.force /= force;
    layer.depth /= length;
    layer.toughness_rate.speed /= length;
    layer.dimple_radius /= length;
    layer.gap /= length;
    layer.stiffness *= length / force;
    if (!layer.aspiration) continue;
    layer.aspiration->tension *= length / force;
    layer.aspiration->tension_scale *= length / force;
  }
  puncture.cytoplasm_viscosity *= length * length / force;
  puncture.shaft.friction /= force;
  puncture.shaft.adhesion *= length / force;
  puncture.shaft.stiffness *= length / force;
  return puncture;
}

}  // namespace

ScaledCell::ScaledCell(const Scene& scene, std::shared_ptr<const SurrogateData> prepared, const Properties& properties,
                       const std::optional<BoreTongue>& tongue, std::optional<PiercedBranch> branch) {
  const double radius = 0.5 * properties.diameter, modulus = scene.cell.material().young_modulus;
  length_ = radius / scene.radius();
  force_ = properties.young_modulus / modulus * length_ * length_;
  force_scale_ = properties.young_modulus * radius * radius;
  Scene here = scene;
  here.cell.material().viscoelasticity.prony = properties.prony;
  here.cell.puncture = onPrepared(properties.puncture, length_, force_);
  if (properties.bore_radius > 0) here.needle.bore_radius = properties.bore_radius / length_;
  cell_ = std::make_unique<PuncturableCell>(here, std::make_unique<SurrogateCellModel>(here, std::move(prepared)),
                                            tongue, std::move(branch));
}

void ScaledCell::setBoreLine(const CellModel::BoreLine& line) {
  const double pressure = force_ / (length_ * length_), volume = length_ * length_ * length_;
  cell_->setBoreLine({line.suction / pressure, line.resistance * volume / pressure});
}

double ScaledCell::boreLength() const { return cell_->bore() ? length_ * cell_->bore()->length : 0; }

double ScaledCell::boreVolume() const {
  return cell_->bore() ? length_ * length_ * length_ * cell_->bore()->volume : 0;
}

Eigen::Vector3d ScaledCell::step(const Eigen::Vector3d& tip, double time) {
  const TipForce answer = cell_->step(tip / length_, Eigen::Vector3d::UnitZ(), time);
  valid_ = answer.valid;
  return force_ * answer.force;
}

}  // namespace microinjection
