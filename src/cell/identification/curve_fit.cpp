#include "cell/identification/curve_fit.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kCauchyScale = 3;     ///< residual over noise from which a sample loses weight
constexpr double kNoiseFactor = 1.05;  ///< a noise that changes less is kept

/// The model's forces and derivatives, once for all samples: a member of a family takes milliseconds.
class Predictions : public ceres::EvaluationCallback {
 public:
  Predictions(CurveModel& model, const Eigen::VectorXd& start) : model_(model), internal(start) {}

  void PrepareForEvaluation(bool, bool new_point) override {
    if (new_point || force.size() == 0) model_.predict(internal, force, jacobian);
  }

 private:
  CurveModel& model_;

 public:
  Eigen::VectorXd internal, force;
  Eigen::MatrixXd jacobian;
};

class SampleResidual : public ceres::CostFunction {
 public:
  SampleResidual(const Predictions& predictions, Eigen::Index index, double measured, double noise)
      : predictions_(predictions), index_(index), measured_(measured), noise_(noise) {
    set_num_residuals(1);
    for (Eigen::Index i = 0; i < predictions.internal.size(); ++i) mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    residuals[0] = (predictions_.force[index_] - measured_) / noise_;
    for (Eigen::Index p = 0; jacobians && p < predictions_.internal.size(); ++p) {
      if (jacobians[p]) jacobians[p][0] = predictions_.jacobian(index_, p) / noise_;
    }
    return true;
  }

 private:
  const Predictions& predictions_;
  Eigen::Index index_;
  double measured_, noise_;
};

/// The inverse of J^T W J for the unknowns that were free.
Eigen::MatrixXd covarianceOf(const Predictions& at, const ForceCurve& curve, double noise,
                             const std::vector<bool>& free) {
  std::vector<Eigen::Index> indices;
  for (std::size_t p = 0; p < free.size(); ++p) {
    if (free[p]) indices.push_back(static_cast<Eigen::Index>(p));
  }
  const auto count = static_cast<Eigen::Index>(indices.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < at.force.size(); ++i) {
    const double residual = (at.force[i] - curve.force[static_cast<std::size_t>(i)]) / noise;
    const double weight = 1 / (1 + std::pow(residual / kCauchyScale, 2));
    Eigen::VectorXd row(count);
    for (Eigen::Index p = 0; p < count; ++p) row[p] = at.jacobian(i, indices[static_cast<std::size_t>(p)]) / noise;
    normal += weight * row * row.transpose();
  }
  const Eigen::MatrixXd inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
  for (Eigen::Index p = 0; p < count; ++p) {
    for (Eigen::Index q = 0; q < count; ++q) {
      covariance(indices[static_cast<std::size_t>(p)], indices[static_cast<std::size_t>(q)]) = inverse(p, q);
    }
  }
  return covariance;
}

double robustDeviation(std::vector<double> residuals) {
  for (double& x : residuals) x = std::abs(x);
  return 1.4826 * upperMedian(std::move(residuals));
}

/// The larger one of both sides of the contact: samples that a model cannot follow are no outliers.
double noiseBesideContact(const ForceCurve& curve, double contact, const Eigen::VectorXd& force) {
  std::vector<double> before, behind;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    (curve.position[i] < contact ? before : behind).push_back(curve.force[i] - force[static_cast<Eigen::Index>(i)]);
  }
  const auto [least, most] = std::minmax_element(curve.force.begin(), curve.force.end());
  return std::max({robustDeviation(before), robustDeviation(behind), kLeastRelativeNoise * (*most - *least)});
}

}  // namespace

CurveFit fitCurve(CurveModel& model, const Eigen::VectorXd& start, double noise, const std::vector<int>& held) {
  Predictions predictions(model, start);
  ceres::Problem::Options options;
  options.evaluation_callback = &predictions;
  ceres::Problem problem(options);
  std::vector<double*> blocks;
  for (Eigen::Index p = 0; p < start.size(); ++p) blocks.push_back(&predictions.internal[p]);
  const ForceCurve& curve = model.curve();
  auto* loss = new ceres::CauchyLoss(kCauchyScale);  // the problem owns it
  for (std::size_t i = 0; i < curve.size(); ++i) {
    problem.AddResidualBlock(new SampleResidual(predictions, static_cast<Eigen::Index>(i), curve.force[i], noise), loss,
                             blocks);
  }
  std::vector<bool> free(blocks.size(), true);
  for (std::size_t p = 0; p < blocks.size(); ++p) {
    const CurveModel::Unknown& unknown = model.unknowns()[p];
    const bool fixed =
        unknown.low == unknown.high || std::find(held.begin(), held.end(), static_cast<int>(p)) != held.end();
    free[p] = !fixed;
    if (fixed) {
      problem.SetParameterBlockConstant(blocks[p]);
    } else if (unknown.low > -1e299) {
      problem.SetParameterLowerBound(blocks[p], 0, unknown.low);
      problem.SetParameterUpperBound(blocks[p], 0, unknown.high);
    }
  }
  ceres::Solver::Options solver;
  solver.max_num_iterations = 100;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.function_tolerance = 1e-9;
  solver.parameter_tolerance = 1e-9;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  CurveFit fit;
  fit.internal = predictions.internal;
  fit.cost = summary.final_cost;
  fit.noise = noise;
  fit.converged = summary.IsSolutionUsable() && fit.internal.allFinite();
  fit.reason = fit.converged ? "" : summary.message;
  model.predict(fit.internal, predictions.force, predictions.jacobian);
  fit.covariance = covarianceOf(predictions, curve, noise, free);
  return fit;
}

CurveFit fitCurveAndNoise(CurveModel& model, double noise) {
  Eigen::VectorXd start(static_cast<Eigen::Index>(model.unknowns().size())), force;
  for (Eigen::Index p = 0; p < start.size(); ++p) start[p] = model.unknowns()[static_cast<std::size_t>(p)].value;
  CurveFit fit = fitCurve(model, start, noise);
  for (int round = 0; round < 3; ++round) {
    Eigen::MatrixXd jacobian;
    model.predict(fit.internal, force, jacobian);
    const int contact = model.index("contact");
    const double found = noiseBesideContact(
        model.curve(), model.unknowns()[static_cast<std::size_t>(contact)].si(fit.internal[contact]), force);
    const double change = std::max(found / fit.noise, fit.noise / found);
    if (round > 0 && change < kNoiseFactor) break;
    fit = fitCurve(model, fit.internal, found);
  }
  return fit;
}

double correlationLength(const Eigen::VectorXd& residuals) {
  constexpr double kWindow = 5;  // Sokal: sum up to five times the length itself
  const Eigen::Index count = residuals.size();
  const double square = residuals.squaredNorm();
  if (!(square > 0)) return 1;
  double length = 1;
  for (Eigen::Index lag = 1; lag < count / 4; ++lag) {
    length += 2 * residuals.head(count - lag).dot(residuals.tail(count - lag)) / square;
    if (static_cast<double>(lag) >= kWindow * std::max(length, 0.2)) break;
  }
  return std::max(1.0, length);
}

}  // namespace microinjection
