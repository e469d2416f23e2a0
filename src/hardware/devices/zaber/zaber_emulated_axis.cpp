#include "hardware/devices/zaber/zaber_emulated_axis.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr double kIntegrationStep = 0.5e-3;  // s, of the motion's integration
constexpr double kSpeedData = 1.6384;        // for 1 microstep/s
constexpr double kAccelData = 1.6384e-4;     // for 1 microstep/s^2
constexpr long long kLargestData = 2147483647;

/// The order of the protocol manual of 2018.
const std::vector<std::string>& importance() {
  static const std::vector<std::string> flags{"FD", "FQ", "FS", "FT", "FB", "FP", "FE", "WH", "WL", "WP",
                                              "WV", "WT", "WM", "WR", "NC", "NI", "ND", "NU", "NJ"};
  return flags;
}

/// Lower is more important. A flag that is not in the manual of 2018 follows those of its kind.
std::pair<int, std::ptrdiff_t> rank(const std::string& flag) {
  const auto& order = importance();
  const int kind = flag[0] == 'F' ? 0 : flag[0] == 'W' ? 1 : 2;
  return {kind, std::find(order.begin(), order.end(), flag) - order.begin()};
}

std::optional<long long> whole(const std::string& word) {
  const auto value = parseNumber<long long>(word);
  return value && std::abs(*value) <= kLargestData ? value : std::nullopt;
}

std::string ok(double value) { return "OK " + std::to_string(std::llround(value)); }

}  // namespace

std::vector<std::string> sortedZaberFlags(std::vector<std::string> flags) {
  std::sort(flags.begin(), flags.end(), [](const auto& a, const auto& b) { return rank(a) < rank(b); });
  flags.erase(std::unique(flags.begin(), flags.end()), flags.end());
  return flags;
}

std::string zaberFlagShown(const std::vector<std::string>& flags) {
  return flags.empty() ? "--" : sortedZaberFlags(flags).front();
}

std::string listOfZaberFlags(const std::vector<std::string>& flags) {
  char number[8];
  std::snprintf(number, sizeof(number), "%02d", static_cast<int>(flags.size()));
  std::string list = number;
  for (const std::string& flag : flags) list += " " + flag;
  return list;
}

ZaberEmulatedAxis::ZaberEmulatedAxis(const Config& config)
    : config_(config),
      position_(std::round(config.start)),
      max_speed_(std::llround(config.speed * kSpeedData)),
      acceleration_(std::llround(config.acceleration * kAccelData)),
      deceleration_(acceleration_) {
  if (!config.referenced) restart();
}

std::vector<std::string> ZaberEmulatedAxis::flags() const {
  std::vector<std::string> up(raised_.begin(), raised_.end());
  if (!referenced_) up.emplace_back("WR");
  return sortedZaberFlags(up);
}

void ZaberEmulatedAxis::advance(double time) {
  for (double left = time; left > 0; left -= kIntegrationStep) {
    if (busy()) step(std::min(kIntegrationStep, left));
    if (!homing_ || busy()) continue;
    homing_ = false;
    referenced_ = true;
    zero_ = 0;
  }
}

void ZaberEmulatedAxis::step(double dt) {
  const double faster = move_acceleration_ * dt, slower = move_braking_ * dt;  // microsteps/s
  double wanted = target_velocity_;
  if (to_position_) {
    const double left = target_ - position_;
    // The speed from which it can brake in time, with an allowance for the integration step.
    const double braking = std::sqrt(2 * move_braking_ * std::abs(left) + slower * slower / 4) - slower / 2;
    wanted = std::copysign(std::min(move_speed_, braking), left);
    if (std::abs(left) < 0.5 && std::abs(velocity_) <= 2 * slower) {
      position_ = target_;
      velocity_ = 0;
      to_position_ = false;
      return;
    }
  }
  const bool speeds_up = std::abs(wanted) > std::abs(velocity_) && wanted * velocity_ >= 0;
  const double change = speeds_up ? faster : slower;
  velocity_ += std::clamp(wanted - velocity_, -change, change);
  position_ += velocity_ * dt;
  if (!homing_ && (position_ < 0 || position_ > config_.travel)) {
    position_ = std::clamp(position_, 0.0, config_.travel);
    velocity_ = target_velocity_ = 0;
    to_position_ = false;
  }
  if (!busy()) position_ = std::round(position_);
}

std::string ZaberEmulatedAxis::perform(const std::vector<std::string>& words) {
  const std::string verb = words.empty() ? "" : words[0], what = words.size() > 1 ? words[1] : "";
  const std::vector<std::string> data(words.begin() + std::min<std::ptrdiff_t>(2, words.size()), words.end());
  if (verb.empty()) return "OK 0";
  if (verb == "stop" || verb == "estop") return stop(verb == "estop");
  if (verb == "warnings") return warnings(what == "clear");
  if (verb == "home") return home();
  if (verb == "get" && data.empty()) return get(what);
  if (verb == "set" && data.size() == 1) return set(what, data[0]);
  if (verb == "move") return move(what, data);
  return "RJ BADCOMMAND";
}

std::string ZaberEmulatedAxis::get(const std::string& name) const {
  if (name == "pos") return ok(count());
  if (name == "limit.min") return ok(0);
  if (name == "limit.max") return ok(std::floor(config_.travel));
  if (name == "maxspeed") return ok(static_cast<double>(max_speed_));
  if (name == "accel" || name == "motion.accelonly") return ok(static_cast<double>(acceleration_));
  if (name == "motion.decelonly") return ok(static_cast<double>(deceleration_));
  if (name == "resolution") return ok(resolution_);
  return "RJ BADCOMMAND";
}

std::string ZaberEmulatedAxis::set(const std::string& name, const std::string& data) {
  const std::optional<long long> value = whole(data);
  const auto within = [&](double least, double most) { return value && *value >= least && *value <= most; };
  if (name == "maxspeed") {
    if (!within(1, largestSpeedData())) return "RJ BADDATA";
    max_speed_ = *value;
  } else if (name == "accel" || name == "motion.accelonly" || name == "motion.decelonly") {
    if (!within(0, kLargestData)) return "RJ BADDATA";
    if (name != "motion.decelonly") acceleration_ = *value;
    if (name != "motion.accelonly") deceleration_ = *value;
  } else if (name == "resolution") {
    if (!within(1, 256)) return "RJ BADDATA";
    resolution_ = static_cast<int>(*value);
  } else if (name == "pos") {
    if (busy()) return "RJ STATUSBUSY";
    if (!within(-kLargestData, kLargestData)) return "RJ BADDATA";
    zero_ = position_ - static_cast<double>(*value);
    referenced_ = true;
  } else {
    return "RJ BADCOMMAND";
  }
  return "OK 0";
}

std::string ZaberEmulatedAxis::warnings(bool clear) {
  const std::string before = listOfZaberFlags(flags());
  if (clear) raised_.clear();
  return "OK " + before;
}

std::string ZaberEmulatedAxis::stop(bool at_once) {
  if (busy()) raised_.insert("NI");
  to_position_ = homing_ = false;
  target_velocity_ = 0;
  move_braking_ = static_cast<double>(deceleration_) / kAccelData;
  if (at_once) velocity_ = 0;
  return "OK 0";
}

std::string ZaberEmulatedAxis::home() {
  if (busy()) raised_.insert("NI");
  homing_ = to_position_ = true;
  target_ = 0;
  move_speed_ = static_cast<double>(max_speed_) / kSpeedData;
  move_acceleration_ = static_cast<double>(acceleration_) / kAccelData;
  move_braking_ = static_cast<double>(deceleration_) / kAccelData;
  return "OK 0";
}

/// `data`: position or velocity, and from firmware 7.25 on optionally speed (not for a velocity)
/// and acceleration.
std::string ZaberEmulatedAxis::move(const std::string& how, const std::vector<std::string>& data) {
  if (how != "abs" && how != "rel" && how != "vel" && how != "min" && how != "max") return "RJ BADCOMMAND";
  if (!raised_.empty() && sortedZaberFlags({raised_.begin(), raised_.end()})[0][0] == 'F') return "RJ STATUSBUSY";
  const bool to_end = how == "min" || how == "max", at_velocity = how == "vel";
  const std::size_t needed = to_end ? 0 : 1;
  const std::size_t allowed = needed + (!config_.move_speeds ? 0 : at_velocity ? 1 : 2);
  if (data.size() < needed || data.size() > allowed) return "RJ BADDATA";
  std::vector<long long> values;
  for (const std::string& word : data) {
    const std::optional<long long> value = whole(word);
    if (!value) return "RJ BADDATA";
    values.push_back(*value);
  }
  std::optional<long long> speed, acceleration;
  if (!at_velocity && values.size() > needed) speed = values[needed];
  if (values.size() > needed + (at_velocity ? 0 : 1)) acceleration = values.back();
  if (at_velocity ? std::abs(static_cast<double>(values[0])) > largestSpeedData()
                  : speed && (*speed < 1 || static_cast<double>(*speed) > largestSpeedData())) {
    return "RJ BADDATA";
  }
  if (acceleration && *acceleration < 1) return "RJ BADDATA";
  double target = how == "max" ? std::floor(config_.travel) : 0;  // microsteps from the home position
  if (!to_end && !at_velocity) {
    target = static_cast<double>(values[0]) + (how == "abs" ? zero_ : std::round(position_));
    if (target < 0 || target > config_.travel || (!referenced_ && how == "abs")) return "RJ BADDATA";
  }
  if (busy()) {
    raised_.insert("NI");
  } else {
    raised_.erase("NI");
  }
  target_ = target;
  move_speed_ = static_cast<double>(speed.value_or(max_speed_)) / kSpeedData;
  move_acceleration_ = static_cast<double>(acceleration.value_or(acceleration_)) / kAccelData;
  move_braking_ = static_cast<double>(acceleration.value_or(deceleration_)) / kAccelData;
  homing_ = false;
  to_position_ = !at_velocity;
  target_velocity_ = at_velocity ? static_cast<double>(values[0]) / kSpeedData : 0;
  if (to_position_) ++moves_begun_;
  return "OK 0";
}

void ZaberEmulatedAxis::shift(double displacement) { position_ = std::round(position_ + displacement); }

void ZaberEmulatedAxis::interrupt() {
  if (busy()) raised_.insert("NI");
  to_position_ = homing_ = false;
  target_velocity_ = 0;
}

void ZaberEmulatedAxis::raise(const std::string& flag) {
  if (flag == "WR") {
    referenced_ = false;
    return;
  }
  raised_.insert(flag);
  if (flag[0] != 'F') return;
  to_position_ = homing_ = false;
  velocity_ = target_velocity_ = 0;
}

void ZaberEmulatedAxis::restart() {
  raised_.clear();
  to_position_ = homing_ = referenced_ = false;
  velocity_ = target_velocity_ = 0;
  position_ = zero_ = std::round(position_);
}

}  // namespace microinjection
