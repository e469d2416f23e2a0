#include "operation/control/needle_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microinjection {
namespace {

/// Smallest noise, as a share of the contact force: without it, rounding of a noiseless force would
/// be a contact.
constexpr double kSmallestNoise = 0.1;
constexpr double kFalselyConfirmed = 1e-4;  ///< probability
constexpr int kSmoothed = 32;               ///< samples
constexpr int kPrompt = 4;                  ///< samples; a stab is 1 um deeper after five
constexpr int kCrest = 8;                   ///< samples, for the crest of a force that rises in tens of milliseconds

}  // namespace

DetectionConfig DetectionConfig::read(ConfigReader& reader) {
  DetectionConfig config;
  reader.integer("noise_samples", config.noise_samples, Range::closed(20, 100000));
  reader.number("contact_force", config.contact_force, Range::positive());
  reader.number("contact_false_rate", config.contact_false_rate, Range::open(0, 0.01));
  reader.integer("confirm_samples", config.confirm_samples, Range::closed(1, 10000));
  reader.number("puncture_drop", config.puncture_drop, Range::open(0, 1));
  reader.number("puncture_false_rate", config.puncture_false_rate, Range::open(0, 0.01));
  reader.integer("puncture_pause", config.puncture_pause, Range::closed(0, 10000));
  return config;
}

NeedleMonitor::NeedleMonitor(const DetectionConfig& config)
    : config_(config), noise_(config.noise_samples, kSmallestNoise * config.contact_force, config.contact_force) {}

void NeedleMonitor::reset() { *this = NeedleMonitor(config_); }

void NeedleMonitor::rearm() {
  if (contact_) contact_->reset();
  skip();
  contact_point_.reset();
  confirmed_.reset();
  confirmation_samples_ = 0;
  confirmation_sum_ = depth_ = max_depth_ = peak_ = peak_mean_force_ = force_before_ = 0;
  punctured_ = false;
}

void NeedleMonitor::skip() {
  travel_.reset();
  reading_.reset();
  if (puncture_) puncture_->reset();
}

double NeedleMonitor::force() const { return puncture_ ? puncture_->meanForce(kSmoothed) : 0; }

double NeedleMonitor::promptForce() const { return puncture_ ? puncture_->meanForce(kPrompt) : 0; }

void NeedleMonitor::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& force) {
  const double axial = force.dot(axis);
  stride_ += (1 + std::exchange(moves_, 0) - stride_) / kSmoothed;
  punctured_ = false;
  if (!noise_.ready()) {
    noise_.add(axial);
    if (!noise_.ready()) return;
    contact_.emplace(noise_, config_.contact_force, config_.contact_false_rate);
    puncture_.emplace(noise_, config_.puncture_drop, config_.puncture_false_rate, config_.puncture_pause);
    return;
  }
  reading_ = axial - offset();
  peak_ = std::max(peak_, std::abs(axial - offset()));
  peak_mean_force_ = std::max(peak_mean_force_, puncture_->meanForce(kCrest));
  const double travel = -tip.dot(axis);
  const bool fell = puncture_->step(axial - offset(), travel);
  if (!contact_point_) {
    const double advance = travel - travel_.value_or(travel);
    travel_ = travel;
    if (!contact_->step(axial, advance)) return;
    contact_point_ = tip;
  }
  follow(tip, axis);
  if (!confirmed_) confirmContact(axial);
  punctured_ = fell;
  if (!fell) return;
  force_before_ = peak_mean_force_;
  peak_mean_force_ = 0;
}

void NeedleMonitor::move(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) {
  punctured_ = false;
  reading_.reset();
  ++moves_;
  if (puncture_) puncture_->wait();
  follow(tip, axis);
}

void NeedleMonitor::follow(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) {
  if (!contact_point_) return;
  depth_ = depthOf(tip, axis);
  max_depth_ = std::max(max_depth_, depth_);
}

void NeedleMonitor::confirmContact(double axial) {
  confirmation_sum_ += axial - offset();
  if (++confirmation_samples_ < config_.confirm_samples) return;
  const double uncertainty = noise_.deviation() * std::sqrt(1.0 / confirmation_samples_ + 1.0 / noise_.samples());
  confirmed_ = confirmation_sum_ / confirmation_samples_ > normalQuantile(kFalselyConfirmed) * uncertainty;
}

}  // namespace microinjection
