#include "cell/family/family_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cell/family/family_places.h"

namespace microinjection {
namespace {

constexpr double kLengths[] = {1, 1.5, 2, 3, 4.5, 9}, kNoises[] = {1e-6, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2};
constexpr double kDefaultLength = 2;
constexpr Eigen::Index kGridded = 3;  ///< most coordinates that are tried on a grid; more: one length after the other
constexpr int kSweeps = 3;
constexpr double kLarge = 0.02;   ///< of the largest force: smaller ones have no error
constexpr double kOutlier = 0.1;  ///< error above which a place does not count more

/// Forces at places, xyz each.
Eigen::VectorXd forcesAt(const ForceField& field, const std::vector<ContactPlace>& places) {
  Eigen::VectorXd forces(3 * static_cast<Eigen::Index>(places.size()));
  ForceField::Local local;
  Eigen::Matrix3d jacobian;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || places[i].angle != places[i - 1].angle) field.makeLocal(places[i].angle, local);
    forces.segment<3>(3 * static_cast<Eigen::Index>(i)) = local.evaluate(places[i].displacement, jacobian);
  }
  return forces;
}

/// Sum of the squared errors.
double badness(const std::vector<std::vector<double>>& errors) {
  double sum = 0;
  for (const auto& member : errors) {
    for (const double error : member) sum += std::pow(std::min(error, kOutlier), 2);
  }
  return sum;
}

}  // namespace

LeaveOneOut::LeaveOneOut(const Family& family, const std::vector<FamilyMember>& members,
                         const std::vector<double>& scales, const std::vector<AxisCurve>& curves)
    : scales_(scales), with_curves_(!curves.empty()) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    const FamilyMember& at = members[i];
    const SurrogatePlan plan = planMember(family, family.member(at.coordinates));
    const std::vector<ContactPlace> places = forcePlaces(plan);
    Member member;
    member.scale = at.scale;
    std::vector<const FamilyMember*> others;
    for (const FamilyMember& other : members) {
      if (&other != &at) others.push_back(&other);
    }
    member.reached = at.reached.share;
    if (!others.empty()) member.reached = std::min(member.reached, reachedAt(at.coordinates, others).share);
    for (const ContactPlace& place : places) member.shares.push_back(place.share);
    for (const FamilyMember& other : members) {
      ForceField field(plan.scales);
      field.setCoefficients(other.field);
      if (&other == &at) member.own = forcesAt(field, places);
      if (with_curves_) field.scaleAlongPaths(curveRatio(curves[i], other, field, plan.scales), curves[i]);
      member.forces.push_back(forcesAt(field, places));
    }
    members_.push_back(std::move(member));
  }
}

std::vector<std::vector<double>> LeaveOneOut::errors(const Eigen::MatrixXd& weights) const {
  std::vector<std::vector<double>> result(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Eigen::VectorXd& own = members_[i].own;
    Eigen::VectorXd predicted = Eigen::VectorXd::Zero(own.size());
    double log_scale = 0;
    for (std::size_t j = 0; j < members_.size(); ++j) {
      const double weight = weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      predicted += weight * members_[i].forces[j];
      log_scale += weight * std::log(members_[j].scale);
    }
    const double scale = scales_.empty() ? std::exp(log_scale) : scales_[i];
    predicted *= (with_curves_ ? 1 : scale) / members_[i].scale;
    const Eigen::Map<const Eigen::Matrix3Xd> truth(own.data(), 3, own.size() / 3);
    const Eigen::Map<const Eigen::Matrix3Xd> guess(predicted.data(), 3, own.size() / 3);
    const double largest = truth.colwise().norm().maxCoeff();
    for (Eigen::Index k = 0; k < truth.cols(); ++k) {
      const double force = truth.col(k).norm();
      const bool served = members_[i].shares[static_cast<std::size_t>(k)] <= members_[i].reached;
      if (served && force > kLarge * largest) result[i].push_back((guess.col(k) - truth.col(k)).norm() / force);
    }
  }
  return result;
}

Covariance chooseCovariance(const Eigen::MatrixXd& points, const PredictionErrors& errors) {
  const Eigen::Index dimension = points.rows();
  Covariance best{Eigen::VectorXd::Constant(dimension, kDefaultLength), kNoises[0]};
  if (points.cols() < 4 * dimension) return best;
  double least = std::numeric_limits<double>::infinity();
  const auto tryOne = [&](const Covariance& trial) {
    const double bad = badness(errors(Kriging(points, trial.lengths, trial.noise).leaveOneOut()));
    if (bad >= least) return;
    least = bad;
    best = trial;
  };
  constexpr int kCount = sizeof(kLengths) / sizeof(*kLengths);
  if (dimension <= kGridded) {
    const auto combinations = static_cast<int>(std::lround(std::pow(kCount, dimension)));
    for (const double noise : kNoises) {
      for (int i = 0; i < combinations; ++i) {
        Covariance trial{Eigen::VectorXd(dimension), noise};
        for (Eigen::Index k = 0, rest = i; k < dimension; ++k, rest /= kCount)
          trial.lengths[k] = kLengths[rest % kCount];
        tryOne(trial);
      }
    }
    return best;
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index k = 0; k < dimension; ++k) {
      const Covariance from = best;
      for (const double noise : kNoises) {
        for (const double length : kLengths) {
          Covariance trial = from;
          trial.noise = noise;
          trial.lengths[k] = length;
          tryOne(trial);
        }
      }
    }
  }
  return best;
}

}  // namespace microinjection
