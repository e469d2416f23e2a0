#include "rig/devices/zaber/zaber_driver.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kLongestExtrapolation = 0.2;  // s, for which an extrapolated position is meaningful
constexpr double kSlowReplies = 2;             // times the expected time, from which slow replies are reported

std::string stopAll(const ZaberConfig& config) {
  std::string bytes;
  for (const ZaberAddress& address : config.addresses) bytes += zaberCommand(address, "stop", config.checksum);
  return bytes;
}

bool hasZaberReply(const std::string& answer) {
  const std::vector<ZaberMessage> messages = ZaberParser(false).feed(answer);
  return std::any_of(messages.begin(), messages.end(),
                     [](const ZaberMessage& message) { return message.kind == ZaberMessage::Kind::kReply; });
}

}  // namespace

ZaberDriver::ZaberDriver(const ZaberConfig& config, std::unique_ptr<Wire> wire)
    : SerialManipulator(std::move(wire),
                        {"Zaber", stopAll(config), config.answer_time + 60 * config.byteTime() + 5e-3,
                         config.reply_timeout + (kZaberCommandBytes + kZaberReplyBytes) * config.byteTime(), "", "#"}),
      config_(config),
      parser_(config.reply_checksum),
      answer_time_(config.answer_time),
      acceleration_(config.acceleration),
      may_home_(config.home) {
  // The empty command: no letter that another device could take for one of its own.
  askFirst({"/\n", hasZaberReply, "a Zaber", config.reply_timeout});
}

double ZaberDriver::gain() const {
  // A loop with a dead time T is well damped up to a gain of about 0.4 / T; a turn has six
  // exchanges.
  return config_.gain > 0 ? config_.gain : 0.3 / (7 * exchangeTime());
}

/// Time (s) after which a motion ends unless renewed; longer than in the file if the line is slow.
double ZaberDriver::horizon() const {
  return std::max(config_.move_horizon, 1.1 * config_.leastHorizon(turnTime(), acceleration_));
}

/// Includes one exchange for the list of an axis with a warning.
double ZaberDriver::turnTime() const {
  const bool warns = std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return !axis.shown_flag.empty(); });
  return (kZaberTurn + (warns ? 1 : 0)) * exchangeTime();
}

/// Maximum age (s) of a position: two turns, one missing reply, and a stop, in which an axis is
/// polled alone.
double ZaberDriver::longestAge() const {
  return 2 * turnTime() + config_.reply_timeout + answer_time_ + config_.speed / acceleration_;
}

double ZaberDriver::longestExtrapolation() const { return std::max(kLongestExtrapolation, 1.3 * turnTime()); }

/// Limited to the speed from which the axis can brake in the distance at which it is slowed down.
double ZaberDriver::fastest(int i) const { return std::min({config_.speed, speedLimits()[i], acceleration_ / gain()}); }

/// Device data of a speed (m/s), never above the axis' fastest.
long long ZaberDriver::speedData(int i, double speed) const {
  const double unit = config_.microsteps_per_metre[i] * kZaberSpeedUnit;
  const auto most = static_cast<long long>(fastest(i) * unit);
  return std::clamp(std::llround(speed * unit), -most, most);
}

ManipulatorAbilities ZaberDriver::abilities() const {
  ManipulatorAbilities abilities;
  abilities.device = "Zaber (ASCII protocol" + axesNote() + ")";
  abilities.follows = true;
  abilities.command_interval = abilities.reading_interval = turnTime();
  abilities.resolution = 1 / config_.microsteps_per_metre.minCoeff();
  abilities.speed = std::min(config_.speed, speedLimits().maxCoeff());
  abilities.latency = 4 * exchangeTime();  // half a turn of waiting, and its own transmission
  const double wire = stopAll(config_).size() * config_.byteTime();
  abilities.stop_time = wire + answer_time_ + abilities.speed / acceleration_;
  return abilities;
}

/// Properties of the connected devices that concern an operator.
std::string ZaberDriver::axesNote() const {
  std::string note;
  if (std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.settings.oldFirmware(); })) {
    note += "; firmware before 7.25, a velocity does not end by itself";
  }
  if (answer_time_ > kSlowReplies * config_.answer_time) {
    note += "; answers take " + std::to_string(std::lround(1e3 * answer_time_)) +
            " ms: lower the latency timer of the serial adapter";
  }
  return note;
}

std::string ZaberDriver::note() const {
  std::string note;
  for (int i = 0; i < 3; ++i) {
    if (axes_[i].shown_flag.empty()) continue;
    note += (note.empty() ? "" : ", ") + axisName(i) + " warns " + axes_[i].shown_flag;
  }
  return note;
}

double ZaberDriver::expected(int i, double at) const {
  const Axis& axis = axes_[i];
  if (!axis.position) return std::nan("");
  const double travel = axis.velocity * std::max(0.0, at - axis.position_time);
  if (std::isnan(axis.end)) return *axis.position + travel;
  const double left = axis.end - *axis.position;
  return *axis.position + (std::abs(travel) < std::abs(left) ? travel : left);  // never past the end of the move
}

std::optional<ManipulatorDevice::Reading> ZaberDriver::reading() const {
  Eigen::Vector3d device, velocity;
  for (int i = 0; i < 3; ++i) {
    if (!axes_[i].position || !axes_[i].has_reference || !positionsValid()) return std::nullopt;
    device[i] = expected(i, time());
    velocity[i] = !std::isnan(axes_[i].end) && device[i] == axes_[i].end ? 0 : axes_[i].velocity;
  }
  return Reading{config_.joints.toJoints(device), config_.joints.directions.cwiseProduct(velocity)};
}

bool ZaberDriver::moving() const {
  if (!goal()) return std::any_of(axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.busy; });
  if (!goal()->follows) return !move_done_;
  const Eigen::Vector3d wanted = config_.joints.toDevice(goal()->joints);
  for (int i = 0; i < 3; ++i) {
    const double away = std::abs(wanted[i] - axes_[i].position.value_or(wanted[i]));
    if (axes_[i].sent_velocity.value_or(1) != 0 || away > 1 / config_.microsteps_per_metre[i]) return true;
    if (axes_[i].busy || !axes_[i].read_since_command || axes_[i].filter.isImplausible()) return true;
  }
  return false;
}

void ZaberDriver::goalChanged() {
  move_stage_ = move_tries_ = 0;
  move_done_ = false;
}

void ZaberDriver::exchange(const std::string& bytes) {
  for (const ZaberMessage& message : parser_.feed(bytes)) {
    handle(message);
    if (!exchanging()) return;
  }
  if (exchange_ && activeTime() > exchange_->due) exchange_->sent ? missedReply() : sendExchange();
  if (!exchange_ && exchanging()) next();
}

int ZaberDriver::axisOf(const ZaberAddress& address) const {
  const auto found = std::find(config_.addresses.begin(), config_.addresses.end(), address);
  return found == config_.addresses.end() ? -1 : static_cast<int>(found - config_.addresses.begin());
}

std::string ZaberDriver::axisName(int axis) const {
  const ZaberAddress& address = config_.addresses[axis];
  return "axis " + std::to_string(address.axis) + " of device " + std::to_string(address.device);
}

}  // namespace microinjection
