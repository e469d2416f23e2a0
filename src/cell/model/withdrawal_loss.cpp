#include "cell/model/withdrawal_loss.h"

#include <algorithm>
#include <boost/math/interpolators/barycentric_rational.hpp>
#include <cmath>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr double kGone = 9.2;  ///< (1 + x) exp(-x) = 0.1 %

/// Through all points, ascending in x.
class Through {
 public:
  Through(const std::vector<double>& x, const std::vector<double>& y)
      : curve_(x.data(), y.data(), x.size(), std::min<std::size_t>(3, x.size() - 1)) {}
  double operator()(double x) const { return curve_(x); }

 private:
  boost::math::barycentric_rational<double> curve_;
};

}  // namespace

double WithdrawalLoss::depthOf(int i, double turn, double pull_depth) {
  return (turn + pull_depth) * std::pow(i / (kKnots - 1.0), 2) - pull_depth;
}

WithdrawalLoss::WithdrawalLoss(const std::vector<Turn>& turns, double error)
    : rows_(kTurns), first_(0), last_(0), error_(error) {
  const bool sized = turns.size() >= 3 && std::all_of(turns.begin(), turns.end(),
                                                      [](const Turn& each) { return each.shares.size() == kKnots; });
  if (!sized) throw std::invalid_argument("the loss on the way out needs three turns, and a share at each knot");
  std::vector<double> knots, roots, pulls, falls, log_roots, log_forces;
  for (int i = 0; i < kKnots; ++i) knots.push_back(i / (kKnots - 1.0));
  for (const Turn& each : turns) {
    roots.push_back(std::sqrt(each.depth));
    pulls.push_back(each.pull_depth);
    falls.push_back(std::log(each.fall));
    log_roots.push_back(std::log(roots.back()));
    log_forces.push_back(std::log(each.force));
  }
  first_ = roots.front();
  last_ = roots.back();
  std::vector<std::vector<double>> losses(kPlaces);
  for (const Turn& each : turns) {
    const Through along(knots, {each.shares.data(), each.shares.data() + kKnots});
    for (int i = 0; i < kPlaces; ++i) losses[i].push_back(each.force * along(i / (kPlaces - 1.0)));
  }
  const auto at = [&](int row) { return first_ + (last_ - first_) * row / (kTurns - 1); };
  const Through pull(roots, pulls), fall(roots, falls), log_force(log_roots, log_forces);
  for (int row = 0; row < kTurns; ++row) {
    rows_[row].pull_depth = std::max(pull(at(row)), 0.0);
    rows_[row].fall = std::exp(fall(at(row)));
  }
  for (int i = 0; i < kPlaces; ++i) {
    const Through over(roots, losses[i]);
    for (int row = 0; row < kTurns; ++row)
      rows_[row].shares[i] = std::max(over(at(row)), 0.0) / std::exp(log_force(std::log(at(row))));
  }
  for (Row& row : rows_) row.shares[kPlaces - 1] = 0;  // at the turn
}

WithdrawalLoss::Between WithdrawalLoss::find(double turn) const {
  const double root = std::clamp(std::sqrt(std::max(turn, 0.0)), first_, last_);
  const double place = (root - first_) / (last_ - first_) * (kTurns - 1);
  const int row = std::min(static_cast<int>(place), kTurns - 2);
  return {row, place - row};
}

double WithdrawalLoss::share(double depth, double turn) const {
  if (!(depth < turn)) return 0;
  const Between between = find(turn);
  const Row &one = rows_[between.row], &two = rows_[between.row + 1];
  const auto mixed = [&](double a, double b) { return a + between.part * (b - a); };
  const double pull = mixed(one.pull_depth, two.pull_depth);
  const auto at = [&](int i) { return mixed(one.shares[i], two.shares[i]); };
  if (depth <= -pull) {
    const double gone = kHalfway * (-pull - depth) / mixed(one.fall, two.fall);
    return gone > kGone ? 0 : at(0) * (1 + gone) * std::exp(-gone);
  }
  const double place = (kPlaces - 1) * std::sqrt((depth + pull) / (turn + pull));
  const int knot = std::min(static_cast<int>(place), kPlaces - 2);
  return at(knot) + (place - knot) * (at(knot + 1) - at(knot));
}

double WithdrawalLoss::reach(double turn) const {
  const Between between = find(turn);
  const auto of = [&](const Row& row) {
    return row.shares[0] > 0 ? row.pull_depth + row.fall * kGone / kHalfway : 0.0;
  };
  const double one = of(rows_[between.row]), two = of(rows_[between.row + 1]);
  return one + between.part * (two - one);
}

}  // namespace microinjection
