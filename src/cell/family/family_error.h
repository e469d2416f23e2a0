#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "cell/family/axis_force.h"
#include "cell/family/family_member.h"
#include "cell/family/kriging.h"

namespace microinjection {

/// Expected relative error of what that a family serves.
struct ExpectedError {
  double median = 0;
  double common = 0;  ///< exceeded by one of ten places
};

/// Relative force error of a family's members, as far as it comes from the interpolation between
/// them: each member is predicted from all others.
class LeaveOneOut {
 public:
  /// Evaluates every member at the places of every other.
  /// @param scales of the members, where they need not be predicted from the others; else empty
  /// @param curves same, of the force on the axis: the others' forces are scaled with them
  LeaveOneOut(const Family& family, const std::vector<FamilyMember>& members, const std::vector<double>& scales,
              const std::vector<AxisCurve>& curves = {});

  /// Errors at all places of each member's paths that it and a prediction of its range reach, where
  /// its force is above a fiftieth of its largest.
  /// @param weights of the other members (columns) in the prediction of each (rows)
  std::vector<std::vector<double>> errors(const Eigen::MatrixXd& weights) const;

 private:
  struct Member {
    double scale = 0;
    double reached = 1;                   ///< share of its paths that it and a prediction from the others reach
    std::vector<double> shares;           ///< of their paths, of the places
    Eigen::VectorXd own;                  ///< forces at its places, over its scale
    std::vector<Eigen::VectorXd> forces;  ///< same of each member, over that one's scale or with this one's curve
  };
  std::vector<Member> members_;
  std::vector<double> scales_;
  bool with_curves_ = false;
};

/// Covariance that predicts the members best.
struct Covariance {
  Eigen::VectorXd lengths;
  double noise = 0;
};

/// Relative errors of each member that is predicted with these weights (rows) from the others.
using PredictionErrors = std::function<std::vector<std::vector<double>>(const Eigen::MatrixXd& weights)>;

/// Chosen among a grid by the errors of leaving members out, with more than three coordinates by descent on it; lengths
/// of 2 for fewer than four times as many members as coordinates.
Covariance chooseCovariance(const Eigen::MatrixXd& points, const PredictionErrors& errors);

}  // namespace microinjection
