#include "vision/dimple/dented_ellipse.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "vision/dimple/dented_model.h"
#include "vision/frame/robust_loss.h"

namespace microinjection {
namespace dented {
namespace {

constexpr double kStartWidths[] = {0.12, 0.25, 0.4};        // of the radius
constexpr double kNarrowestDent = 0.02, kWidestDent = 0.6;  // of the radius
constexpr double kDeepestDent = 0.7;                        // of the radius
constexpr double kLeastTail = 1e-3, kUsualTail = 0.1, kTailDeviation = 0.3;
constexpr double kCauchy = 1, kLeastScale = 0.08;  // px
constexpr int kTukeyRounds = 3, kSteps = 20, kAttempts = 6;
constexpr double kSmallestGain = 1e-5;  // of the cost, of a step that goes on
constexpr std::size_t kLeastPoints = 40;

/// Weight of what is known of the tail, where the residuals' deviation is 1 / kTukey of a loss's scale.
double priorWeight() { return std::pow(RobustLoss::kTukey * kTailDeviation, -2); }

class Fitter {
 public:
  Fitter(const std::vector<BorderPoint>& points, const NeedleAxis& axis, const Ellipse& start)
      : local_(axis, start), tip_(local_.of(axis.tip)), first_(startOf(start, local_)) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].trusted) continue;
      const Eigen::Vector2d place = local_.of(points[i].place), normal(points[i].normal.x, points[i].normal.y);
      // Where the dent is steep an error across the border is a larger one along the needle.
      const double steep = std::abs(normal.dot(local_.u));
      const double usual = std::sqrt(std::max(0.0, 1 - place.x() * place.x()));
      Cost cost{place.x(), place.y(), place.x() - tip_.x(), 1, 1, points[i].facing};
      if (points[i].facing) {
        cost.fade = fadeAt(heightAt(first_, place.x()));
        cost.weight = std::clamp(steep / std::max(usual, 0.2), 0.2, 1.0);
      }
      costs_.push_back(cost);
      index_.push_back(i);
    }
  }

  /// @param before  of an earlier fit, which gives the first dent when it is valid
  DentedEllipse fit(std::size_t count, const DentedEllipse& before) {
    DentedEllipse result;
    if (costs_.size() < kLeastPoints) return result;
    Vector best;
    double least = 1e300;
    const auto start = [&](double depth, double width, double tail) {
      Vector p = first_;
      p.tail<kDent>() << std::clamp(depth, 0.0, kDeepestDent), std::log(width), tail;
      const double cost = solve(p, {kCauchy / local_.unit, false});
      if (!(cost < least)) return;
      least = cost;
      best = p;
    };
    if (before.valid) {
      start(before.depth / local_.unit, before.width / local_.unit, before.tail);
    } else {
      for (const double width : kStartWidths) start(heightAt(first_, tip_.x()) - tip_.y(), width, kUsualTail);
    }
    if (least > 1e299) return result;
    for (int round = 0; round < kTukeyRounds; ++round) {
      if (solve(best, {RobustLoss::kTukey * scaleOf(best), true}) > 1e299) return result;
    }
    describe(best, scaleOf(best), count, result);
    return result;
  }

 private:
  double costOf(const Vector& p, const RobustLoss& loss) const {
    double sum = 0.5 * priorWeight() * (p[kTail] - kUsualTail) * (p[kTail] - kUsualTail);
    for (const Cost& cost : costs_) sum += loss.value(residualOf(cost, p));
    return std::isfinite(sum) && p[2] * p[3] > p[4] * p[4] ? sum : 1e300;
  }

  /// Levenberg and Marquardt's steps. Returns the cost; a huge one without a solution.
  double solve(Vector& p, const RobustLoss& loss) const {
    double now = costOf(p, loss), damping = 1e-3;
    for (int step = 0; step < kSteps; ++step) {
      Matrix matrix = Matrix::Zero();
      Vector right = Vector::Zero();
      matrix(kTail, kTail) = priorWeight();
      right[kTail] = priorWeight() * (kUsualTail - p[kTail]);
      for (const Cost& cost : costs_) {
        const Jet residual = jetOf(cost, p);
        const double weight = loss.weight(residual.a);
        if (weight == 0) continue;
        matrix.selfadjointView<Eigen::Lower>().rankUpdate(residual.v, weight);
        right -= weight * residual.a * residual.v;
      }
      const double before = now;
      for (int attempt = 0; attempt < kAttempts && now >= before; ++attempt) {
        Matrix damped = matrix;
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-9;
        const Vector next = limited(p + damped.selfadjointView<Eigen::Lower>().ldlt().solve(right));
        const double cost = costOf(next, loss);
        damping *= cost < now ? 0.1 : 10;
        if (cost >= now) continue;
        p = next;
        now = cost;
      }
      if (before - now < kSmallestGain * before) break;
    }
    return now;
  }
  static Vector limited(Vector p) {
    p[kDepth] = std::clamp(p[kDepth], -0.1, kDeepestDent);
    p[kLogWidth] = std::clamp(p[kLogWidth], std::log(kNarrowestDent), std::log(kWidestDent));
    p[kTail] = std::clamp(p[kTail], kLeastTail, 1.0);
    return p;
  }

  double scaleOf(const Vector& p) const {
    std::vector<double> sizes;
    for (const Cost& cost : costs_) sizes.push_back(std::abs(residualOf(cost, p)));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return std::max(1.4826 * *middle, kLeastScale / local_.unit);
  }

  /// Normal matrix of the points that the model describes, for neighbours that do not deviate together.
  Matrix information(const Vector& p, double scale, std::vector<bool>& used) const {
    const RobustLoss loss{RobustLoss::kTukey * scale, true};
    Matrix matrix = Matrix::Zero();
    matrix(kTail, kTail) = RobustLoss::kTukey * RobustLoss::kTukey * priorWeight();
    double product = 0, square = 0, last = 0;
    for (std::size_t i = 0; i < costs_.size(); ++i) {
      const Jet residual = jetOf(costs_[i], p);
      // Tukey's weights at a residual of 0 are 1 over the square of his scale.
      const double weight = RobustLoss::kTukey * RobustLoss::kTukey * loss.weight(residual.a);
      used[index_[i]] = weight > 0;
      matrix += weight * residual.v * residual.v.transpose();
      const double rest = std::clamp(residual.a, -3 * scale, 3 * scale);
      product += last * rest;
      square += rest * rest;
      last = rest;
    }
    const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.95) : 0;
    return matrix * (1 - correlation) / (1 + correlation);
  }

  void describe(const Vector& p, double scale, std::size_t count, DentedEllipse& result) const {
    result.used.assign(count, false);
    const Eigen::LDLT<Matrix> solver(information(p, scale, result.used));
    const auto deviationOf = [&](const Vector& row) {
      return local_.unit * std::sqrt(std::max(0.0, row.dot(solver.solve(row))));
    };
    // The ellipse's height on the axis, by the change of a distance there.
    const double height = heightAt(p, tip_.x());
    const Cost on{tip_.x(), height, 0, 0, 1, false}, above{tip_.x(), height + 1e-6, 0, 0, 1, false};
    const Vector top = -jetOf(on, p).v * 1e-6 / (residualOf(above, p) - residualOf(on, p));
    Vector depth = Vector::Zero();
    depth[kDepth] = fadeAt(height);
    result.valid = solver.info() == Eigen::Success;
    result.ellipse = ellipseOf(p, local_);
    result.depth = p[kDepth] * fadeAt(height) * local_.unit;
    result.width = std::exp(p[kLogWidth]) * local_.unit;
    result.tail = p[kTail];
    result.residual = scale * local_.unit;
    result.top_deviation = deviationOf(top);
    result.depth_deviation = deviationOf(depth);
    // Centre across and along the needle, turned into the image.
    Eigen::Matrix2d axes;
    axes << local_.v, local_.u;
    const Eigen::Matrix<double, kShape + kDent, 2> columns =
        solver.solve(Eigen::Matrix<double, kShape + kDent, 2>::Identity());
    result.centre_covariance = local_.unit * local_.unit * axes * columns.topRows<2>() * axes.transpose();
  }

  Local local_;
  Eigen::Vector2d tip_;
  Vector first_;
  std::vector<Cost> costs_;
  std::vector<std::size_t> index_;  ///< of each cost's point
};

}  // namespace
}  // namespace dented

cv::Point2d NeedleAxis::along() const { return {std::cos(direction), std::sin(direction)}; }
cv::Point2d NeedleAxis::across() const { return {-std::sin(direction), std::cos(direction)}; }

double DentedEllipse::top(const NeedleAxis& axis) const { return ellipse.exit(axis.tip, axis.direction).value_or(0); }

double DentedEllipse::displacement(const NeedleAxis& axis, double across) const {
  const double radius = 0.5 * ellipse.meanDiameter();
  const auto fade = [&](double s) {
    const cv::Point2d from = axis.tip + s * axis.across();
    const cv::Point2d place = from + ellipse.exit(from, axis.direction).value_or(0) * axis.along();
    return dented::fadeAt((place - ellipse.centre).dot(axis.along()) / radius);
  };
  const double ratio = across / width;
  return depth / std::max(fade(0), 0.1) * fade(across) * dented::bell(ratio * ratio, tail);
}

DentedEllipse fitDentedEllipse(const std::vector<BorderPoint>& points, const NeedleAxis& axis, const Ellipse& start) {
  return dented::Fitter(points, axis, start).fit(points.size(), {});
}

DentedEllipse fitDentedEllipse(const std::vector<BorderPoint>& points, const NeedleAxis& axis,
                               const DentedEllipse& start) {
  return dented::Fitter(points, axis, start.ellipse).fit(points.size(), start);
}

}  // namespace microinjection
