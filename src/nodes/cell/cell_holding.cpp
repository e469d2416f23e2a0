#include "nodes/cell/cell_holding.h"

#include <cmath>

#include "cell/family/tongue_family.h"
#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kHoldPeriod = 0.01;    ///< s, of /cell/hold without a change
constexpr double kHolderTimeout = 0.1;  ///< s, past which the diagnostics name it
constexpr double kMouthTimeout = 0.1;   ///< s

PipetteMouth mouthOf(const Scene& scene) {
  const Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  return PipetteMouth(mouth.inner_radius, mouth.outer_radius, mouth.edge_radius, 1);
}

CellMotionConfig motionOf(const Scene& scene, CellMotionConfig motion) {
  motion.radius = scene.radius();
  return motion;
}

}  // namespace

CellHolding::Config CellHolding::Config::read(ConfigReader& reader) {
  Config config;
  reader.boolean("holder", config.holder);
  reader.choice("holder_rig", config.holder_rig, {"none", "measured", "true"});
  config.motion.read(reader.section("holding"));
  return config;
}

std::string CellHolding::refusal(const Scene& scene) {
  if (!scene.holding_pipette.mouth) return "the scene has no holding_pipette/mouth: the cell is fixed to its pipette";
  return scene.needle.tip.rounded() ? "" : "the scene's tip is a disc: the cell is fixed to its pipette";
}

CellHolding::CellHolding(Cycle& cycle, const Scene& scene, const Config& config, const std::string& families)
    : holder_(cycle.input<cell_microinjection::HolderState>("holder/state", InputPhase::kSampled, kHolderTimeout)),
      state_(cycle.bus().advertise<cell_microinjection::CellHold>("cell/hold", 10)),
      seal_(cycle.bus().advertise<cell_microinjection::HoldingSeal>("cell/seal", 10)),
      hold_(motionOf(scene, config.motion), mouthOf(scene),
            RoundedTip(scene.needle.tip.radius, scene.needle.tip.edgeRadius())),
      radius_(scene.radius()),
      modulus_(scene.cell.tensegrity ? 1 : scene.cell.material().young_modulus) {
  if (config.holder_rig != "none") {
    mouth_ = &cycle.input<geometry_msgs::PoseStamped>("holder_rig/" + config.holder_rig + "_cp", InputPhase::kSampled,
                                                      kMouthTimeout);
  }
  std::string reason;
  tongue_ = findFamilyTongue(families, scene, reason);
  cycle.diagnostics().add("hold", [this](auto& status) { report(status); });
}

const Eigen::Vector3d& CellHolding::step(const Cycle::Tick& tick, const std::optional<Eigen::Isometry3d>& needle,
                                         bool inside) {
  const auto* holder = holder_.get(tick.now);
  // CellMotion has the pipette's resistance. The pressure at the mouth jumps as the cell closes it.
  if (holder && std::isfinite(holder->line_pressure)) input_.pressure = holder->line_pressure;
  if (mouth_) {
    if (const auto pose = validPose(mouth_->get(tick.now))) {
      if (!mouth_start_) mouth_start_ = pose->translation();
      input_.mouth = pose->translation() - *mouth_start_;
    }
  }
  input_.needle.reset();
  if (needle) input_.needle = CellHold::Needle{needle->translation(), needle->linear().col(2), inside};
  return hold_.step(tick.dt, input_).offset;
}

/// All is not a number where it is not known.
DrawnTongue CellHolding::tongue() const {
  if (!tongue_ || !hold_.state().sealed) return {};
  return tongue_->at(std::max(-input_.pressure, 0.0) / modulus_);
}

void CellHolding::publish(const ros::Time& now) {
  const bool is_due = isDue(published_, now, kHoldPeriod);
  if (hold_.state().mode == published_mode_ && !is_due) return;
  published_mode_ = hold_.state().mode;
  const DrawnTongue drawn = tongue();
  publishHold(now, drawn.length * radius_);
  // At even times: its inflow is the mean since the last one.
  if (!is_due) return;
  const double passed = published_.isZero() ? 0 : secondsBetween(published_, now);
  published_ = now;
  const double volume = std::isfinite(drawn.volume) ? drawn.volume * std::pow(radius_, 3) : 0;
  cell_microinjection::HoldingSeal seal;
  seal.header.stamp = now;
  seal.resistance = hold_.state().seal_resistance;
  seal.inflow = passed > 0 ? (volume - tongue_volume_) / passed : 0;
  tongue_volume_ = volume;
  seal_.publish(seal);
}

void CellHolding::publishHold(const ros::Time& now, double tongue_length) {
  const CellHold::State& hold = hold_.state();
  cell_microinjection::CellHold state;
  state.header.stamp = now;
  state.mode = name(hold.mode);
  state.offset = toMessage<geometry_msgs::Vector3>(hold.offset);
  state.orientation.w = hold.orientation.w();
  state.orientation.x = hold.orientation.x();
  state.orientation.y = hold.orientation.y();
  state.orientation.z = hold.orientation.z();
  state.sealed = hold.sealed;
  state.pressure = input_.pressure;
  state.load = hold.load;
  state.limit = hold.limit;
  state.leak = hold.leak;
  state.tongue = tongue_length;
  state_.publish(state);
}

void CellHolding::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const CellHold::State& hold = hold_.state();
  using diagnostic_msgs::DiagnosticStatus;
  status.summary(hold.mode == CellMode::kHeld ? DiagnosticStatus::OK : DiagnosticStatus::WARN, name(hold.mode));
  status.add("load (N)", hold.load);
  status.add("limit (N)", hold.limit);
}

}  // namespace microinjection
