#include "benchmark/common/teleoperation_loop.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "operation/link/link_follower.h"
#include "operation/link/link_leader.h"

namespace microinjection {
namespace {

constexpr double kPeriod = 1e-3;     // s, of bridge and rig
constexpr int kSubsteps = 20;        // of the hand within it: the device's force is held, the hand is not
constexpr int kFound = 1000;         // periods before the start, with a link that has epochs
constexpr double kTimeout = 0.3;     // s without a value: the needle holds, the hand feels nothing
constexpr double kServoTime = 2e-3;  // s, by which the needle lags behind its target
constexpr double kFree = 5e-3;       // m above what is touched
constexpr double kInEnd = 1.0, kHalfOut = 6.0, kHalfOutEnd = 6.2, kOut = 10.0, kOutEnd = 10.5, kEnd = 11.0;  // s
constexpr double kChatterStart = 1.5, kChatterEnd = 2.0, kChatterPeriod = 0.08;                              // s

/// From 0 to 1 within [start, end] with the least jerk, as a reaching hand moves.
double reach(double time, double start, double end) {
  const double x = std::clamp((time - start) / (end - start), 0.0, 1.0);
  return x * x * x * (10 + x * (-15 + 6 * x));
}

/// Root mean square of the hand about its straight line over [start, start + 1 s): a hand that
/// creeps does not oscillate.
double amplitude(const std::vector<TeleoperationLoop::Sample>& samples, double start) {
  const auto first = static_cast<Eigen::Index>(std::lround(start / kPeriod));
  const auto count = static_cast<Eigen::Index>(std::lround(1.0 / kPeriod));
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(count, -1, 1);
  Eigen::VectorXd hand(count);
  for (Eigen::Index i = 0; i < count; ++i) hand[i] = samples[first + i].hand;
  hand.array() -= hand.mean();
  hand -= hand.dot(time) / time.squaredNorm() * time;
  return hand.norm() / std::sqrt(static_cast<double>(count));
}

/// What crosses a network without waves: a value alone.
struct Packet {
  double sent = 0;  ///< s
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// The newest of them; nothing once that came too long ago.
class Inbox {
 public:
  void receive(const Packet& packet) {
    if (newest_ && packet.sent <= newest_->sent) return;
    newest_ = packet;
    fresh_ = true;
  }
  std::optional<Eigen::Vector3d> value(double now) {
    if (std::exchange(fresh_, false)) received_ = now;
    if (!newest_ || now - received_ > kTimeout) return std::nullopt;
    return newest_->value;
  }

 private:
  std::optional<Packet> newest_;
  bool fresh_ = false;
  double received_ = 0;  ///< s
};

/// The whole loop's state, tick by tick. Everything moves along z; what is touched fills z < 0.
class Simulation {
 public:
  explicit Simulation(const TeleoperationLoop& loop)
      : loop_(loop),
        hand_(loop.hand, Eigen::Vector3d(0, 0, kFree)),
        bridge_(withController(loop)),
        wave_leader_(loop.wave, loop.bridge.motion.position_scale, loop.bridge.force_gain, 1),
        wave_follower_(loop.wave),
        wave_forward_(loop.link),
        wave_back_(otherSeed(loop.link)),
        forward_(loop.link),
        back_(otherSeed(loop.link)),
        needle_(kFree) {
    if (loop.makeTouched) touched_ = loop.makeTouched();
    deep_ = TeleoperationLoop::kPressedForce * (1 / loop.stiffness + 1 / loop.hand.stiffness);
  }

  TeleoperationLoop::Result run() {
    // The two ends of the link find each other before the hand sets out.
    for (int i = wave() ? -kFound : 0; i * kPeriod < kEnd - kPeriod / 2; ++i) tick(i * kPeriod);
    auto& samples = result_.samples;
    if (wave()) samples.erase(samples.begin(), samples.begin() + kFound);
    for (const double start : {4.0, 8.0}) {
      const double early = amplitude(samples, start), late = amplitude(samples, start + 1);
      if (late < result_.late_amplitude) continue;
      result_.late_amplitude = late;
      result_.late_over_early = early > 0 ? late / early : 0;
    }
    for (int i = 0; i < 1000; ++i) {
      result_.contact_force += samples[5000 + i].force / 1000;
      result_.needle_force += samples[5000 + i].touched / 1000;
    }
    const auto hand = [](const auto& a, const auto& b) { return a.hand < b.hand; };
    const auto needle = [](const auto& a, const auto& b) { return a.needle < b.needle; };
    result_.overshoot = std::max(0.0, std::min_element(samples.begin(), samples.end(), hand)->hand -
                                          std::min_element(samples.begin(), samples.end(), needle)->needle);
    return result_;
  }

 private:
  static HapticBridgeConfig withController(const TeleoperationLoop& loop) {
    HapticBridgeConfig config = loop.bridge;
    if (loop.controller == TeleoperationLoop::Controller::kWave) config = config.beforeLink();
    config.passivity.enabled = loop.controller != TeleoperationLoop::Controller::kOff;
    config.engagement.speed_limit = 1e3;  // m/s: that a fast hand is let go of would hide what is not passive
    return config;
  }
  static LinkConditions otherSeed(LinkConditions link) {
    link.seed += 1000;
    return link;
  }

  bool wave() const { return loop_.controller == TeleoperationLoop::Controller::kWave; }

  void tick(double now) {
    const double force = stepBridge(now);
    moveHand(now, force);
    const double moved = hand_.position().z();
    stepRig(now);
    result_.samples.push_back({now, moved, needle_, force, touch_, bridge_.observedEnergy()});
    result_.observed_energy_min = std::min(result_.observed_energy_min, bridge_.observedEnergy());
    result_.true_energy_min = std::min(result_.true_energy_min, true_energy_);
    if (wave()) result_.margin_min = std::min({result_.margin_min, wave_leader_.margin(), wave_follower_.margin()});
    result_.peak_force = std::max(result_.peak_force, std::abs(force));
    result_.peak_force_rate = std::max(result_.peak_force_rate, std::abs(force - last_force_) / kPeriod);
    last_force_ = force;
    result_.drift = std::abs(needle_ - wanted_) * loop_.bridge.motion.position_scale;
  }

  /// Force on the hand (N) for the next period.
  double stepBridge(double now) {
    for (const LinkPacket& packet : wave_back_.receive(now)) wave_leader_.receive(packet);
    for (const Packet& packet : back_.receive(now)) force_inbox_.receive(packet);
    const auto reflected = wave() ? wave_leader_.step(kPeriod) : force_inbox_.value(now);
    const double scale = loop_.bridge.motion.position_scale;
    HapticBridge::Input input;
    const double resolution = loop_.device_resolution;
    const double encoder = std::round(hand_.position().z() / resolution) * resolution;
    input.hand = Eigen::Vector3d(0, 0, encoder);
    input.needle = wave() ? wave_leader_.needle() : Eigen::Vector3d(0, 0, scale * needle_);
    if (reflected) input.force.predicted = *reflected / loop_.bridge.force_gain;
    const HapticBridge::Output output = bridge_.step(input, kPeriod);
    if (output.needle) wanted_ = output.needle->z() / scale;
    if (wave()) {
      wave_leader_.setTarget(output.needle);
      wave_forward_.send(wave_leader_.packet(), now);
    } else if (output.needle) {
      forward_.send({now, Eigen::Vector3d(0, 0, wanted_)}, now);
    }
    return output.hand_force.z();
  }

  void moveHand(double now, double force) {
    const double dt = kPeriod / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      const double time = now + (i + 1) * dt;
      const double depth = kFree + deep_;
      const double meant = kFree - depth * (reach(time, 0.3, kInEnd) - 0.5 * reach(time, kHalfOut, kHalfOutEnd) -
                                            0.5 * reach(time, kOut, kOutEnd));
      const double before = hand_.position().z();
      const double total = force - loop_.device_damping * hand_speed_;
      hand_.step(Eigen::Vector3d(0, 0, meant), Eigen::Vector3d(0, 0, total), dt);
      hand_speed_ = (hand_.position().z() - before) / dt;
      true_energy_ -= force * (hand_.position().z() - before);
    }
  }

  void stepRig(double now) {
    for (const LinkPacket& packet : wave_forward_.receive(now)) wave_follower_.receive(packet);
    for (const Packet& packet : forward_.receive(now)) goal_inbox_.receive(packet);
    const double touched_before = touch_;
    touch_ = touch(now);
    touched_energy_ -= 0.5 * (touched_before + touch_) * (needle_ - touched_at_);
    touched_at_ = needle_;
    result_.touched_energy_min = std::min(result_.touched_energy_min, touched_energy_);
    const Eigen::Vector3d force(0, 0, touch_);
    const double scale = loop_.bridge.motion.position_scale;
    std::optional<Eigen::Vector3d> goal;
    if (wave()) {
      goal = wave_follower_.step({Eigen::Vector3d(0, 0, scale * needle_), force / loop_.bridge.force_gain}, kPeriod);
      if (goal) *goal /= scale;
      wave_back_.send(wave_follower_.packet(), now);
    } else {
      goal = goal_inbox_.value(now);
      back_.send({now, force}, now);
    }
    if (!goal) return;
    needle_ += (1 - std::exp(-kPeriod / kServoTime)) * (goal->z() - needle_);
  }

  /// N at the hand's scale, of what is touched on the needle.
  double touch(double now) {
    if (touched_) return touched_(needle_);
    const bool gone = loop_.chatter && now >= kChatterStart && now < kChatterEnd &&
                      std::fmod(now - kChatterStart, kChatterPeriod) < kChatterPeriod / 2;
    return gone ? 0 : loop_.stiffness * std::max(0.0, -needle_);
  }

  const TeleoperationLoop& loop_;
  TeleoperationLoop::Touched touched_;
  VirtualHand hand_;
  HapticBridge bridge_;
  Inbox force_inbox_, goal_inbox_;
  LinkLeader wave_leader_;
  LinkFollower wave_follower_;
  LinkEmulator<LinkPacket> wave_forward_, wave_back_;
  LinkEmulator<Packet> forward_, back_;
  double needle_;                                   ///< m, at the hand's scale
  double wanted_ = kFree;                           ///< m, at the hand's scale, by the bridge
  double deep_ = 0;                                 ///< m, below the surface, where the hand means to be
  double hand_speed_ = 0;                           ///< m/s
  double true_energy_ = 0;                          ///< J
  double touch_ = 0;                                ///< N, of what is touched
  double touched_at_ = kFree, touched_energy_ = 0;  ///< m, J, of the needle there and of what it has given
  double last_force_ = 0;                           ///< N
  TeleoperationLoop::Result result_;
};

}  // namespace

TeleoperationLoop::Result TeleoperationLoop::run() const { return Simulation(*this).run(); }

}  // namespace microinjection
