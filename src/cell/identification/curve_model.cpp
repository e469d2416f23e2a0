#include "cell/identification/curve_model.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

enum Index { kModulus = 0, kContact = 1, kOffset = 2, kDrift = 3 };

constexpr double kLength = 1e-7;                         // m
constexpr double kLeastModulus = 1, kMostModulus = 1e8;  // Pa
constexpr double kLeastShare = 1e-3, kMostShare = 10;    // of a Prony term, over the lasting force

}  // namespace

double CurveModel::Unknown::si(double internal) const { return logarithm ? std::exp(internal) : scale * internal; }

CurveModel::CurveModel(const ForceCurve& curve, std::shared_ptr<ElasticLaw> law, const CurveModelConfig& config)
    : curve_(curve), law_(std::move(law)), terms_(curve.timed ? config.prony_terms : 0) {
  const auto [least, most] = std::minmax_element(curve.force.begin(), curve.force.end());
  const double size = *most - *least, duration = curve.time.back() - curve.time.front();
  unknowns_.push_back({"young_modulus", "Pa", true, 0, 1, std::log(kLeastModulus), std::log(kMostModulus)});
  unknowns_.push_back({"contact", "m", false, 0, kLength});
  unknowns_.push_back({"offset", "N", false, 0, 0.01 * size});
  const std::string rate = curve.timed ? "N/s" : "N/sample";
  unknowns_.push_back({"drift", rate, false, 0, 0.01 * size / std::max(duration, 1e-9)});
  if (!config.drift) unknowns_.back().low = unknowns_.back().high = 0;
  ratios_ = static_cast<int>(unknowns_.size());
  for (const ElasticLaw::Parameter& ratio : law_->parameters()) {
    const double low = std::log(ratio.low), high = std::log(ratio.high);
    unknowns_.push_back({ratio.name, "", true, std::clamp(std::log(ratio.value), low, high), 1, low, high});
  }
  prony_ = static_cast<int>(unknowns_.size());
  for (int k = 0; k < terms_; ++k) {
    const std::string number = terms_ > 1 ? "_" + std::to_string(k + 1) : "";
    // To begin with, the times divide the record's length evenly on the logarithmic scale.
    const double time = duration * std::pow(0.1, (k + 1.0) / (terms_ + 1.0));
    unknowns_.push_back(
        {"modulus_ratio" + number, "", true, std::log(0.2), 1, std::log(kLeastShare), std::log(kMostShare)});
    unknowns_.push_back(
        {"relaxation_time" + number, "s", true, std::log(time), 1, std::log(1e-3 * duration), std::log(10 * duration)});
  }
}

void CurveModel::start(double modulus, double contact, double offset, double drift) {
  unknowns_[kModulus].value = std::clamp(std::log(modulus), unknowns_[kModulus].low, unknowns_[kModulus].high);
  unknowns_[kContact].value = contact / kLength;
  unknowns_[kOffset].value = offset / unknowns_[kOffset].scale;
  unknowns_[kDrift].value = unknowns_[kDrift].low == 0 ? 0 : drift / unknowns_[kDrift].scale;
}

int CurveModel::index(const std::string& name) const {
  const auto found = std::find_if(unknowns_.begin(), unknowns_.end(), [&](const auto& x) { return x.name == name; });
  return found == unknowns_.end() ? -1 : static_cast<int>(found - unknowns_.begin());
}

void CurveModel::predict(const Eigen::VectorXd& internal, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian) {
  const auto count = static_cast<Eigen::Index>(curve_.size());
  force.setZero(count);
  jacobian.setZero(count, static_cast<Eigen::Index>(unknowns_.size()));
  addElastic(internal, force, jacobian);
  if (terms_ > 0) addRelaxation(internal, force, jacobian);
  const double offset = unknowns_[kOffset].si(internal[kOffset]), drift = unknowns_[kDrift].si(internal[kDrift]);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double since = curve_.time[static_cast<std::size_t>(i)] - curve_.time.front();
    force[i] += offset + drift * since;
    jacobian(i, kOffset) = unknowns_[kOffset].scale;
    jacobian(i, kDrift) = unknowns_[kDrift].scale * since;
  }
}

void CurveModel::addElastic(const Eigen::VectorXd& internal, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian) {
  const int ratios = prony_ - ratios_;
  if (ratios > 0) law_->set(internal.segment(ratios_, ratios).array().exp());
  const double modulus = unknowns_[kModulus].si(internal[kModulus]);
  const double contact = unknowns_[kContact].si(internal[kContact]);
  Eigen::VectorXd by_ratios;
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    const double depth = curve_.position[static_cast<std::size_t>(i)] - contact;
    if (depth <= 0) continue;
    const ElasticLaw::Value value = law_->force(depth, by_ratios);
    force[i] = modulus * value.force;
    jacobian(i, kModulus) = force[i];
    jacobian(i, kContact) = -modulus * value.stiffness * unknowns_[kContact].scale;
    if (ratios > 0) jacobian.row(i).segment(ratios_, ratios) = modulus * by_ratios.transpose();
  }
}

/// Every term adds beta L(F) with the linear operator L of ForceMemory, so its derivatives are beta L
/// of the elastic ones; that by the relaxation time is a difference.
void CurveModel::addRelaxation(const Eigen::VectorXd& internal, Eigen::VectorXd& force,
                               Eigen::MatrixXd& jacobian) const {
  const Eigen::Index count = force.size();
  const auto relax = [&](auto elastic, double time, auto result) {
    double branch = 0, before = elastic[0];
    for (Eigen::Index i = 1; i < count; ++i) {
      const double ratio =
          (curve_.time[static_cast<std::size_t>(i)] - curve_.time[static_cast<std::size_t>(i - 1)]) / time;
      const double share = ratio > 0 ? -std::expm1(-ratio) / ratio : 1;
      branch = std::exp(-ratio) * branch + share * (elastic[i] - before);
      before = elastic[i];
      result[i] = branch;
    }
  };
  const Eigen::VectorXd elastic = force;
  const Eigen::MatrixXd by_elastic = jacobian.leftCols(prony_);
  constexpr double kStep = 1e-4;
  for (int k = 0; k < terms_; ++k) {
    const int own = prony_ + 2 * k;
    const double share = unknowns_[own].si(internal[own]), time = unknowns_[own + 1].si(internal[own + 1]);
    Eigen::VectorXd part = Eigen::VectorXd::Zero(count), above = part, below = part;
    relax(elastic, time, Eigen::Ref<Eigen::VectorXd>(part));
    relax(elastic, time * std::exp(kStep), Eigen::Ref<Eigen::VectorXd>(above));
    relax(elastic, time * std::exp(-kStep), Eigen::Ref<Eigen::VectorXd>(below));
    force += share * part;
    jacobian.col(own) = share * part;
    jacobian.col(own + 1) = share * (above - below) / (2 * kStep);
    for (int p = 0; p < prony_; ++p) {
      if (p == kOffset || p == kDrift) continue;
      Eigen::VectorXd derivative = Eigen::VectorXd::Zero(count);
      relax(by_elastic.col(p), time, Eigen::Ref<Eigen::VectorXd>(derivative));
      jacobian.col(p) += share * derivative;
    }
  }
}

}  // namespace microinjection
