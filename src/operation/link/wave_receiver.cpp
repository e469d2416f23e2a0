#include "operation/link/wave_receiver.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

// Share of the reserve that is kept while a wave is held for late packets. A held wave u is
// corrected with the time t. Its integral's excess after a time s is m = u t (1 - exp(-s / t)) and
// has cost u^2 t (1 - exp(-2 s / t)) / 4. Correcting it when no more packets come costs no more,
// m^2 / (4 t).
constexpr double kKept = 0.5;

}  // namespace

void WavePlayout::receive(const TeleoperationPacket& packet) {
  const std::uint64_t sequence = packet.sequence;
  if (sequence == 0 || !packet.value.allFinite() || !std::isfinite(packet.energy)) return;
  if (newest_ == 0 && sequence >= kLength) return;  // too late to begin
  if (static_cast<double>(sequence) < playout_position_ || sequence + kLength <= newest_) return;
  sent_[sequence % kLength] = {sequence, packet.value, packet.energy};
  newest_ = std::max(newest_, sequence);
}

WavePlayout::Sent WavePlayout::at(double sequence) const {
  // Interpolates from the last played period, or a later received one, to the next received one.
  auto after = static_cast<std::uint64_t>(std::ceil(sequence));
  while (sent_[after % kLength].sequence != after) ++after;
  const Sent& end = sent_[after % kLength];
  Sent start = last_;
  double from = playout_position_;
  for (auto before = static_cast<std::uint64_t>(std::floor(sequence)); static_cast<double>(before) > playout_position_;
       --before) {
    if (sent_[before % kLength].sequence != before) continue;
    start = sent_[before % kLength];
    from = static_cast<double>(before);
    break;
  }
  const double interval = static_cast<double>(after) - from;
  const double share = interval > 0 ? (sequence - from) / interval : 1;
  return {0, start.integral + share * (end.integral - start.integral),
          start.energy + share * (end.energy - start.energy)};
}

std::optional<WavePlayout::Advance> WavePlayout::advance() {
  if (newest_ == 0) return std::nullopt;
  constexpr double kCatchUpGain = 1e-4, kLargestCatchUp = 1e-2;  // 1 a period
  if (++observed_ == kObserved) {
    catch_up_ = std::min(kLargestCatchUp, kCatchUpGain * std::max(0.0, smallest_buffer_ - 2));
    observed_ = 0;
    smallest_buffer_ = kLength;
  }
  double next = playout_position_ + 1 + catch_up_;
  // Far behind, after a burst, packets that do not fit the buffer are skipped as if lost.
  next = std::max(next, static_cast<double>(newest_) - (kLength - 2));
  if (next > static_cast<double>(newest_)) {
    smallest_buffer_ = catch_up_ = 0;
    return Advance{Eigen::Vector3d::Zero(), 0, true};
  }
  smallest_buffer_ = std::min(smallest_buffer_, buffered());
  const Sent now = at(next);
  const Advance advance{now.integral - last_.integral, now.energy - last_.energy, false};
  last_ = now;
  playout_position_ = next;
  return advance;
}

WaveReceiverConfig WaveReceiverConfig::read(ConfigReader& reader) {
  WaveReceiverConfig config;
  reader.number("filter_time", config.filter_time, Range::positive());
  reader.number("highpass_loss", config.highpass_loss, Range::closed(0, 0.5));
  reader.number("correction_time", config.correction_time, Range::positive());
  reader.number("reserve", config.reserve, Range::positive());
  return config;
}

void WaveReceiver::reset() {
  playout_.reset();
  for (Eigen::Vector3d* zero : {&slow_, &filtered_, &wave_, &wanted_, &emitted_integral_}) zero->setZero();
  in_ = out_ = 0;
  credit_ = config_.reserve;
}

const Eigen::Vector3d& WaveReceiver::step(double round_trip, double dt) {
  const auto advance = playout_.advance();
  if (!advance) return wave_;
  const double slowness = std::max(round_trip, dt);
  if (!advance->underrun) {
    const Eigen::Vector3d wave = advance->integral / dt;
    wanted_ += advance->integral;
    slow_ += (1 - std::exp(-dt / slowness)) * (wave - slow_);
    const Eigen::Vector3d shelved = wave + config_.highpass_loss * (slow_ - wave);
    filtered_ += (1 - std::exp(-dt / config_.filter_time)) * (shelved - filtered_);
    in_ += advance->energy;
    credit_ += advance->energy;
  }
  // The filters' lag of the integral is time constant times output.
  const Eigen::Vector3d missing =
      wanted_ - emitted_integral_ - config_.filter_time * filtered_ - config_.highpass_loss * slowness * slow_;
  wave_ = filtered_ + missing / config_.correction_time;
  // The energy in the filters will leave them; the energy that they removed is gone.
  const double held =
      0.5 * (config_.filter_time * filtered_.squaredNorm() + config_.highpass_loss * slowness * slow_.squaredNorm());
  const double energy_margin = std::max(0.0, credit_ - (advance->underrun ? held + kKept * config_.reserve : 0));
  const double energy = 0.5 * wave_.squaredNorm() * dt;
  if (energy > energy_margin) wave_ *= std::sqrt(energy_margin / energy);
  const double spent = std::min(energy, energy_margin);
  emitted_integral_ += dt * wave_;
  out_ += spent;
  credit_ = std::min(credit_ - spent, config_.reserve + held);
  return wave_;
}

}  // namespace microinjection
