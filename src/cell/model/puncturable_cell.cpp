#include "cell/model/puncturable_cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace microinjection {

namespace {

constexpr double kMouth = 1.5;  ///< radii of the tip, of way in which a hole takes in its end
constexpr int kEnergySteps = 32;
constexpr int kFirstLengths = 64;       ///< that are tried where a membrane may stop a first hole
constexpr double kUprightAxis = 0.999;  ///< cosine: the branch is that of an upright needle
constexpr double kInto = 0.01;          ///< tip radii into a layer, from which on the hole is in it
constexpr double kOnAxis = 0.5;         ///< tip radii from the axis: same
constexpr double kAlone = 1e-6;         ///< of the branch's force
constexpr double kGrows = 0.99;         ///< of the crack's cost, that the release of a hole is that has just grown
constexpr double kKnownWay = 4;         ///< tip radii behind the onset, in which the branch's error is known

PunctureConfig punctureOf(const Scene& scene, const std::optional<PiercedBranch>& branch) {
  PunctureConfig config = scene.cell.puncture;
  if (!branch) return config;
  config.shaft.adhesion += config.shaft.coefficient * branch->crack().wall_force;
  return config;
}

/// Of the material that a needle draws in: behind the membranes, the innermost layer.
BoreSuction::Config boreConfig(const Scene& scene) {
  const std::vector<Scene::Layer>& layers = scene.cell.layers;
  return {scene.needle.bore_radius.value_or(0), scene.radius(), layers.back().material.young_modulus,
          scene.cell.puncture.cytoplasm_viscosity};
}

}  // namespace

PuncturableCell::PuncturableCell(const Scene& scene, std::unique_ptr<CellModel> cell, std::optional<BoreTongue> tongue,
                                 std::optional<PiercedBranch> branch, std::optional<double> pierced_error)
    : config_(punctureOf(scene, branch)),
      tip_(scene.needle.tip),
      radius_(scene.radius()),
      cell_(std::move(cell)),
      shaft_(config_.shaft),
      fading_(config_.relaxation_time),
      branch_(std::move(branch)),
      memory_(scene.cell.material().viscoelasticity.prony),
      pierced_error_(pierced_error) {
  invalid_reason_.reserve(200);
  if (tongue) bore_.emplace(boreConfig(scene), std::move(*tongue));
  if (!branch_) return;
  crack_.emplace(*branch_, config_.layers.front().toughness_rate);
  if (branch_->onset() && tip_.taper > 0)
    taper_.emplace(scene, branch_->crack().hole_radius, branch_->onset()->depth - branch_->onset()->length);
  config_.layers.front().force = crack_->onsetForce();
}

TipForce PuncturableCell::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  invalid_reason_.clear();
  inner_force_used_ = false;
  if (!tip.allFinite() || !axis.allFinite() || !std::isfinite(time)) {
    invalid_reason_ = "the needle's pose is not finite";
    pulse_.reset();
    force_error_.reset();
    return {false, Eigen::Vector3d::Zero()};
  }
  const Pose pose{tip, axis, time, last_time_ ? std::max(time - *last_time_, 0.0) : 0};
  stepBore(pose);
  if (crack_) {
    crack_->step(last_time_ ? (last_tip_ - tip).dot(axis) : 0, pose.duration);
    config_.layers.front().force = crack_->onsetForce();
  }
  const TipForce result = computeForce(pose);
  force_error_ = result.valid ? errorOf(result.force, pose) : std::nullopt;
  work_ = workTo(result.force, tip);
  last_force_ = result.force;
  last_tip_ = tip;
  last_time_ = time;
  pulse_.reset();
  return result;
}

std::optional<double> PuncturableCell::errorOf(const Eigen::Vector3d& force, const Pose& pose) const {
  if (!fading_.at(pose.tip, pose.time).isZero(0)) return std::nullopt;
  if (!hole_) return cell_->contact() ? cell_->forceError() : std::optional(0.0);
  if (!pierced_error_ || pose.axis.z() < kUprightAxis || mouth_from_ != 0 || !branch_->onset()) return std::nullopt;
  if (holes_[*hole_].position.head<2>().norm() > kOnAxis * tip_.radius) return std::nullopt;
  const double depth = insertion_.depth, length = holes_[*hole_].length;
  const PiercedBranch::State state = branch_->at(depth, length);
  const PiercedBranch::Resistance resistance = resistanceBefore();
  const double cost = resistance.tougher * branch_->costAt(length) + resistance.at(length);
  const bool grows = state.release > kGrows * cost && depth < branch_->onset()->depth + kKnownWay * tip_.radius;
  const bool alone = (force - state.force * pose.axis).norm() < kAlone * std::abs(state.force);
  return grows && alone ? std::optional(*pierced_error_ * std::abs(state.force)) : std::nullopt;
}

/// What has come before the mouth in the last step is drawn in.
void PuncturableCell::stepBore(const Pose& pose) {
  drawn_through_ = false;
  if (!bore_) return;
  const bool through = covering_ == layerCount();
  bore_->step(line_,
              covering_ < 0 ? BoreSuction::Cover::kMedium
              : through     ? BoreSuction::Cover::kCytoplasm
                            : BoreSuction::Cover::kMembrane,
              pose.duration);
  drawn_through_ = membrane_ && membrane_->step(bore_->reading().tension, pose.duration);
}

/// `layer`: that the tip presses; the count of layers behind the last; -1: none.
void PuncturableCell::coverBore(int layer) {
  if (layer == covering_) return;
  covering_ = layer;
  membrane_.reset();
  const bool breakable = bore_ && layer >= 0 && layer < layerCount() && config_.layers[layer].aspiration;
  if (breakable) membrane_.emplace(*config_.layers[layer].aspiration);
}

/// The needle touches the outermost layer at `point`.
void PuncturableCell::touch(const Eigen::Vector3d& point, const Pose& pose) {
  work_ = 0;
  resealed_ = holes_.under(point, pose.axis, tip_.radius);
  // A touch that is moved onto the needle's line may come to lie in a hole that is open.
  if (resealed_ && !holes_[*resealed_].left) resealed_.reset();
  strength_ = resealed_ ? -std::expm1(-(pose.time - *holes_[*resealed_].left) / config_.resealing_time) : 1;
}

double PuncturableCell::workTo(const Eigen::Vector3d& force, const Eigen::Vector3d& tip) const {
  return last_time_ ? work_ - 0.5 * (last_force_ + force).dot(tip - last_tip_) : 0;
}

TipForce PuncturableCell::computeForce(const Pose& pose) {
  if (!hole_ && !cell_->contact()) {
    const auto hole = holes_.under(pose.tip, pose.axis, tip_.radius);
    const bool open = hole && !holes_[*hole].left;
    if (open && isOut(*hole, pose)) return {true, fading_.at(pose.tip, pose.time)};
    if (open) {
      work_ = 0;
      strength_ = 1;
      memory_.reset();
      enter(*hole, pose);
      mouth_from_ = insertion_.depth;
    }
  }
  if (!hole_) return contactForce(pose);
  if (isOut(*hole_, pose)) {
    leave(pose);
    return {true, fading_.at(pose.tip, pose.time)};
  }
  return {true, forceInside(pose)};
}

TipForce PuncturableCell::contactForce(const Pose& pose) {
  const bool was_in_contact = cell_->contact().has_value();
  inner_force_used_ = true;
  TipForce result = cell_->step(pose.tip, pose.axis, pose.time);
  followRadius();
  if (!result.valid) return result;
  const auto& contact = cell_->contact();
  if (!was_in_contact && contact) touch(contact->contact_point, pose);
  coverBore(contact && !config_.layers.empty() ? 0 : -1);
  const double push = result.force.dot(pose.axis), left = strength_ * strength();
  const bool failed = contact && !config_.layers.empty() &&
                      (drawn_through_ || fails(config_.layers.front(), push, contact->indentation, left));
  if (failed && push > left * config_.layers.front().force) result.force *= left * config_.layers.front().force / push;
  result.force += fading_.at(pose.tip, pose.time);
  if (!failed) return result;
  PunctureHoles::Hole opened;
  opened.position = contact->contact_point;
  const double work = workTo(result.force, pose.tip);
  if (branch_) {
    opened.length = firstLength((opened.position - pose.tip).dot(pose.axis));
    loseToBranch(opened, result.force, work, pose);
  } else {
    fading_.start(result.force, pose.tip, work, pose.time);
  }
  const int hole = resealed_ ? *resealed_ : holes_.add(opened);
  holes_[hole] = opened;
  published_holes_.write(holes_);
  if (!branch_) cell_->release();
  inner_force_used_ = false;
  enter(hole, pose);
  failLayer(pose);
  return result;
}

/// Of the hole that an onset makes at this depth: a membrane in its way may stop it.
double PuncturableCell::firstLength(double depth) const {
  const double onset = std::isfinite(crack_->onsetLength()) ? crack_->onsetLength() : branch_->shortest();
  PiercedBranch::Resistance resistance{crack_->tougher()};
  if (layerCount() > 1) resistance = {crack_->tougher(), config_.layers[1].stiffness, gapsTo(1)};
  const double least = std::clamp(resistance.membrane, branch_->shortest(), std::max(onset, branch_->shortest()));
  const double step = (onset - least) / kFirstLengths;
  double length = onset;
  for (int i = 0; i < kFirstLengths && resistance.at(length) > 0; ++i, length -= step) {
    if (branch_->at(depth, length).release > resistance.tougher * branch_->costAt(length) + resistance.at(length))
      break;
  }
  return branch_->grown(depth, std::max(length, least), resistance);
}

void PuncturableCell::loseToBranch(const PunctureHoles::Hole& opened, const Eigen::Vector3d& force, double work,
                                   const Pose& pose) {
  const double depth = (opened.position - pose.tip).dot(pose.axis), elastic = branch_->whole(depth).force;
  const bool viscous = memory_.isViscous() && elastic > 0;
  const double share = viscous ? std::max(force.dot(pose.axis) / elastic - 1, 0.0) : 0;  // of the elastic force
  mouth_from_ = 0;
  if ((1 + share) * openingEnergy(depth, opened.length) > work) mouth_from_ = depth;
  const Eigen::Vector3d opening = openingForce(depth, opened.length) * pose.axis;
  memory_.start(opening, share * opening);
  const double released = branch_->whole(depth).energy - branch_->at(depth, opened.length).energy -
                          crack_->tougher() * branch_->costUntil(opened.length) - branch_->crack().barrier;
  const double kept = work - (1 + share) * openingEnergy(depth, opened.length);
  fading_.start(force - opening - memory_.viscous(), pose.tip, std::min(released, kept), pose.time);
}

void PuncturableCell::followRadius() {
  const double radius = cell_->radius().value_or(radius_);
  if (radius == radius_) return;
  holes_.scale(radius / radius_);
  published_holes_.write(holes_);
  radius_ = radius;
}

Eigen::Vector3d PuncturableCell::forceInside(const Pose& pose) {
  updateDepth(pose);
  const double age = (pose.time - failed_at_) / config_.relaxation_time;
  const double behind = branch_ ? std::min(insertion_.depth, holes_[*hole_].length) : insertion_.depth;
  const double length = isThrough() ? (behind - next_layer_depth_) * -std::expm1(-std::max(age, 0.0)) : 0;
  const Eigen::Vector3d shaft = shaft_.step(pose.tip, pose.axis, length, pose.duration);
  const Eigen::Vector3d stays = branch_ ? Eigen::Vector3d(shaft + pierce(pose) * pose.axis) : shaft;
  Eigen::Vector3d others = fading_.at(pose.tip, pose.time);
  if (branch_ && !isThrough()) {
    failByBranch(others + stays, pose);
    return others + stays;
  }
  if (isThrough()) {
    coverBore(layerCount());
    return others + stays;
  }
  const Layer& layer = config_.layers[holes_[*hole_].layers];
  const double pushed = std::max(insertion_.depth - next_layer_depth_, 0.0), push = layer.stiffness * pushed;
  coverBore(pushed > 0 ? holes_[*hole_].layers : -1);
  const double left = strength_ * strength();
  others += std::min(push, left * layer.force) * pose.axis;
  if (drawn_through_ || fails(layer, push, pushed, left)) {
    fading_.start(others, pose.tip, workTo(others + stays, pose.tip), pose.time);
    failLayer(pose);
  }
  return others + stays;
}

/// The membrane before the tip, which the needle feels through the branch. When it fails the hole grows at once, and
/// what the needle then feels less fades.
void PuncturableCell::failByBranch(const Eigen::Vector3d& force, const Pose& pose) {
  PunctureHoles::Hole& hole = holes_[*hole_];
  const Layer& layer = config_.layers[hole.layers];
  const double depth = insertion_.depth;
  if (std::isfinite(layer.toughness)) {
    coverBore(hole.layers);
    if (layersWithin(hole.length) <= hole.layers) return;
    const double kept = workTo(force, pose.tip) - openingEnergy(depth, hole.length);
    fading_.start(fading_.at(pose.tip, pose.time) + lost_at_border_ * pose.axis, pose.tip, kept, pose.time);
    failLayer(pose);
    return;
  }
  const PiercedBranch::Resistance resistance = resistanceBefore();
  // No more than what the cell presses the tip with: a needle that goes back leaves the membrane.
  const double pressed = branch_->at(depth, hole.length).release - resistance.tougher * branch_->costAt(hole.length);
  const double push = std::clamp(pressed, 0.0, resistance.at(hole.length));
  coverBore(push > 0 ? hole.layers : -1);
  if (!drawn_through_ && !fails(layer, push, push / layer.stiffness, strength_ * strength())) return;
  const double before = openingForce(depth, hole.length), work = workTo(force, pose.tip);
  const Eigen::Vector3d viscous = memory_.viscous();
  failLayer(pose);
  pierce(pose);
  const double after = openingForce(depth, hole.length), lost = before - after;
  const double stored = openingEnergy(depth, hole.length);
  memory_.start(after * pose.axis, viscous);
  fading_.start(fading_.at(pose.tip, pose.time) + lost * pose.axis, pose.tip, work - stored, pose.time);
}

double PuncturableCell::pierce(const Pose& pose) {
  PunctureHoles::Hole& hole = holes_[*hole_];
  const double depth = insertion_.depth;
  const double before = openingForce(depth, hole.length);
  const int within = layersWithin(hole.length);
  const Eigen::Vector3d viscous_before = memory_.viscous();
  hole.length = branch_->grown(depth, hole.length, resistanceBefore());
  cell_->step(pose.tip + std::min(hole.length, depth) * pose.axis, pose.axis, pose.time);
  const double elastic = openingForce(depth, hole.length);
  lost_at_border_ = 0;
  if (layersWithin(hole.length) > within && before > elastic) {
    lost_at_border_ = before - elastic;
    memory_.start(elastic * pose.axis, viscous_before);
    return std::max(before + viscous_before.dot(pose.axis), 0.0);
  }
  const double viscous = memory_.step(elastic * pose.axis, pose.duration).dot(pose.axis);
  return viscous == 0 ? elastic : std::max(elastic + viscous, 0.0);  // relaxed so far that the cell would pull
}

int PuncturableCell::layersWithin(double length) const {
  int count = 0;
  for (const PiercedBranch::Crack::Part& part : branch_->crack().parts)
    count += length > part.from + kInto * tip_.radius;
  return count;
}

PiercedBranch::Resistance PuncturableCell::resistanceBefore() const {
  if (isThrough()) return {crack_->tougher()};
  return {crack_->tougher(), config_.layers[holes_[*hole_].layers].stiffness, next_layer_depth_};
}

/// A needle that has made the hole stands in it with the whole of its force.
double PuncturableCell::openingForce(double depth, double length) const {
  const double mouth = std::min(kMouth * tip_.radius, branch_->onset() ? branch_->onset()->depth : HUGE_VAL);
  const double force = branch_->at(depth, length).force + (taper_ ? taper_->force(depth) : 0);
  return std::clamp((depth - mouth_from_) / mouth, 0.0, 1.0) * force;
}

/// By the trapezoidal rule.
double PuncturableCell::openingEnergy(double depth, double length) const {
  const double step = (depth - mouth_from_) / kEnergySteps;
  double sum = openingForce(depth, length) / 2;
  for (int i = 1; i < kEnergySteps; ++i) sum += openingForce(mouth_from_ + i * step, length);
  return sum * std::max(step, 0.0);
}

void PuncturableCell::enter(int hole, const Pose& pose) {
  hole_ = hole;
  next_layer_depth_ = gapsTo(holes_[hole].layers);
  failed_at_ = -std::numeric_limits<double>::infinity();
  shaft_.enter(pose.tip);
  insertion_.inside = true;
  insertion_.layers_punctured = holes_[hole].layers;
  updateDepth(pose);
}

void PuncturableCell::leave(const Pose& pose) {
  fading_.start(last_force_, pose.tip, workTo(last_force_, pose.tip), pose.time);
  if (std::isfinite(config_.resealing_time)) holes_[*hole_].left = pose.time;
  if (branch_) cell_->release();
  hole_.reset();
  coverBore(-1);
  strength_ = 1;
  in_contact_.reset();
  insertion_.inside = false;
  insertion_.depth = 0;
}

void PuncturableCell::failLayer(const Pose& pose) {
  insertion_.layers_punctured = ++holes_[*hole_].layers;
  insertion_.punctured = true;
  failed_at_ = pose.time;
  if (branch_) next_layer_depth_ = isThrough() ? 0 : gapsTo(holes_[*hole_].layers);  // the shaft touches the whole wall
  if (!branch_ && !isThrough()) next_layer_depth_ = insertion_.depth + config_.layers[holes_[*hole_].layers].gap;
}

double PuncturableCell::gapsTo(int layer) const {
  double sum = 0;
  for (int i = 1; i <= std::min(layer, layerCount() - 1); ++i) sum += config_.layers[i].gap;
  return sum;
}

bool PuncturableCell::fails(const Layer& layer, double push, double indentation, double strength) {
  if (!pulse_ || pulse_->amplitude <= 0 || indentation <= 0)
    return layer.fails(push, indentation, tip_.radius, strength);
  const bool known = branch_ && &layer == &config_.layers.front();
  const double amplitude = pulse_->amplitude;
  const double stiffness =
      known ? (branch_->whole(indentation + amplitude).force - branch_->whole(indentation).force) / amplitude
            : std::max(push, 0.0) / indentation;
  const StrokeResistance resistance{tip_.radius, config_.cytoplasm_viscosity, stiffness};
  return layer.fails(push + resistance.largestForce(*pulse_), indentation + amplitude, tip_.radius, strength);
}

void PuncturableCell::updateDepth(const Pose& pose) {
  insertion_.depth = (holes_[*hole_].position - pose.tip).dot(pose.axis);
  in_contact_ = Contact{holes_[*hole_].position, pose.tip - holes_[*hole_].position, insertion_.depth};
}

bool PuncturableCell::isOut(int hole, const Pose& pose) const {
  return clearance(pose.tip, pose.axis) >= clearance(holes_[hole].position, pose.axis);
}

double PuncturableCell::clearance(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) const {
  const double rounding = tip_.edgeRadius(), flat = tip_.rounded() ? tip_.radius - rounding : 0;
  const double height = tip.dot(axis), aside = std::max((tip - height * axis).norm() - flat, 0.0);
  const double reach = radius_ + rounding;
  if (aside >= reach) return std::numeric_limits<double>::infinity();
  return height + rounding - std::sqrt(reach * reach - aside * aside);
}

void PuncturableCell::release() {
  cell_->release();
  if (crack_) crack_->reset();
  hole_.reset();
  pulse_.reset();
  coverBore(-1);
  in_contact_.reset();
  insertion_.inside = false;
  insertion_.depth = 0;
}

std::vector<std::string> PuncturableCell::layers() const {
  std::vector<std::string> names;
  for (const Layer& layer : config_.layers) names.push_back(layer.name);
  return names;
}

const std::string& PuncturableCell::invalidReason() const {
  return inner_force_used_ ? cell_->invalidReason() : invalid_reason_;
}

std::optional<CellModel::Solution> PuncturableCell::solution(double time) const {
  if (hole_) return std::nullopt;
  return cell_->solution(time);
}

CellModel::DeformedSurface PuncturableCell::deformedSurface() {
  DeformedSurface surface = cell_->deformedSurface();
  published_holes_.update();
  for (int i = 0; i < published_holes_.value().count(); ++i)
    surface.holes.push_back(published_holes_.value()[i].position);
  return surface;
}

}  // namespace microinjection
