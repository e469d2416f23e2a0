#include "vision/pipette/bore_border.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {
namespace {

constexpr int kBefore = 4;                                             // rows before the pipette's end, in the strip
constexpr int kBoreRows = 400;                                         // px behind the end
constexpr double kRims[] = {3, 5, 7, 10, 14}, kBlurs[] = {1, 2, 3.5};  // px
constexpr double kMostBlur = 0.5;  // of a rim's width: a rim that is more blurred cannot be told from a line
constexpr double kMargin = 4;      // px of a window beside rim and line
constexpr double kBesideFrom = 1.15, kBeside = 0.7;  // of the half width, from where on and how wide is read beside it
constexpr int kBesideGap = 3;                        // px more
constexpr double kCrossing = 0.4;  // of a rim, that is seen on both sides of the pipette: a border that crosses it
constexpr double kSteepestCrossing = 1.2, kBent = 3;  // slope of such a border, and px, that it bends in the pipette
constexpr double kLeastClear = 3, kSureClear = 5;     // rim over its standard deviation
constexpr double kQuietBeside = 0.4;                  // of the rim, of what is seen beside the pipette at most
constexpr double kFlatness = 0.03;     // of the middle's half width: what the bulge of a cap is not known by
constexpr double kModel = 0.35;        // px, what a border differs from the model by
constexpr double kThinnestNeedle = 5;  // px, half width
constexpr double kSureDeviation = 1;   // px
constexpr double kSureBlur = 2.5;      // px, beyond which the line beside a rim displaces it

using Design = Eigen::Matrix<double, Eigen::Dynamic, 5>;
using Coefficients = Eigen::Matrix<double, 5, 1>;

/// A rim and its blur, px.
struct RimShape {
  double width, blur;
  int before() const { return static_cast<int>(std::ceil(kMargin + 0.5 * width + blur)); }
  int after() const { return static_cast<int>(std::ceil(kMargin + width + blur)); }
};

double risen(double u, double blur) { return 0.5 * (1 + std::erf(u / (std::sqrt(2.0) * blur))); }

/// Columns: constant, line, step, rim and bright line, for rows -before to after about a border at `offset`.
Design designOf(const RimShape& shape, const BoreView& view, double offset) {
  const int rows = shape.before() + shape.after() + 1;
  Design design(rows, 5);
  const double first = offset - view.place * shape.width, last = first + shape.width;
  for (int i = 0; i < rows; ++i) {
    const double t = i - shape.before();
    const double from = risen(t - first, shape.blur), to = risen(t - last, shape.blur);
    const double lit = risen(t - first + 0.5 * shape.width, shape.blur) - from;
    design.row(i) << 1, t / rows, risen(t - offset, shape.blur), from - to, view.has_line ? lit : 0;
  }
  return design;
}

/// Least squares of one design, ready for many windows.
class RimModel {
 public:
  RimModel(const RimShape& shape, const BoreView& view, double offset)
      : shape_(shape), design_(designOf(shape, view, offset)), least_rim_(view.least_rim) {
    Eigen::Matrix<double, 5, 5> normal = design_.transpose() * design_;
    normal.diagonal().array() += 1e-9;
    const Eigen::Matrix<double, 5, 5> inverse = normal.inverse();
    solve_ = inverse * design_.transpose();
    rim_variance_ = inverse(3, 3);
    const auto line = design_.leftCols<2>();
    plain_ = (line.transpose() * line).inverse() * line.transpose();
  }

  struct Fit {
    double rim = 0;       ///< of the mean grey value, positive: dark
    double clear = 0;     ///< rim over its standard deviation
    double gain = 0;      ///< squares of the residual without rim over those with it, per degree of freedom
    double residual = 0;  ///< sum of squares
  };
  Fit at(const Eigen::VectorXd& profile, int row, double noise) const {
    const auto window = profile.segment(row - shape_.before(), design_.rows());
    const Coefficients c = solve_ * window;
    const auto freedom = static_cast<double>(design_.rows() - 5);
    Fit fit;
    fit.residual = (window - design_ * c).squaredNorm();
    const double variance = std::max(noise * noise, fit.residual / freedom);
    const double plain = (window - design_.leftCols<2>() * (plain_ * window)).squaredNorm();
    fit.rim = -c[3] / std::max(window.mean(), 1e-6);
    fit.clear = -c[3] / std::sqrt(variance * rim_variance_);
    // A bright line lies beside a dark rim, not a dark one.
    const bool is_rim = fit.rim > least_rim_ && fit.clear > kLeastClear && c[4] > 0.5 * c[3];
    fit.gain = is_rim ? (plain - fit.residual) / variance : 0;
    return fit;
  }
  const RimShape& shape() const { return shape_; }

 private:
  RimShape shape_;
  Design design_;
  double least_rim_;
  Eigen::Matrix<double, 5, Eigen::Dynamic> solve_;
  Eigen::Matrix<double, 2, Eigen::Dynamic> plain_;
  double rim_variance_;
};

struct BoreCandidate {
  int row = 0;
  RimShape shape{0, 0};
  RimModel::Fit fit;
};

/// Mean of the columns [first, last] of a row.
double meanOf(const PipetteStrip& strip, int row, int first, int last) {
  const float* grey = strip.grey().ptr<float>(row) + strip.half();
  double sum = 0;
  for (int side = first; side <= last; ++side) sum += grey[side];
  return sum / (last - first + 1);
}

class BoreSearch {
 public:
  BoreSearch(const Frame& frame, const PipetteDetection& pipette, const BoreView& view)
      : pipette_(pipette), view_(view), strip_(frame, shapeOf(), 0.4, 0.4) {
    while (rows_ < strip_.rows() && strip_.contains(rows_, 0)) ++rows_;
    const int middle = std::max(1, static_cast<int>(view.middle));
    bore_.resize(rows_);
    for (int row = 0; row < rows_; ++row) bore_[row] = meanOf(strip_, row, -middle, middle);
    // The strip is interpolated and smoothed, which takes a part of the noise away and joins neighbours.
    noise_ = 0.7 * frame.noise() / std::sqrt(2.0 * middle + 1);
  }

  BoreBorder find() {
    BoreBorder found;
    found.finding = Finding::notFound("nothing is seen in the bore");
    search();
    const BoreCandidate* best = farthest();
    if (best == nullptr) return found;
    refine(*best, found);
    if (!(found.deviation < kSureDeviation) || best->shape.blur > kSureBlur)
      found.finding = Finding::uncertain("the border in the bore is blurred");
    if (!isClear(*best)) found.finding = Finding::uncertain("the border in the bore is faint");
    if (besides(*best) > kQuietBeside * best->fit.rim)
      found.finding = Finding::uncertain("something like the border in the bore is seen beside the pipette");
    if (best->row + best->shape.after() + 2 * view_.one_border > rows_)
      found.finding = Finding::uncertain("the bore leaves the image behind what is seen in it");
    if (!pipette_.finding.isFound()) found.finding = Finding::uncertain("the pipette's end is not sure");
    return found;
  }

 private:
  PipetteStrip::Shape shapeOf() const {
    const cv::Point2d axis(std::cos(pipette_.direction), std::sin(pipette_.direction));
    PipetteStrip::Shape shape;
    shape.origin = pipette_.end - kBefore * axis;
    shape.direction = pipette_.direction;
    shape.rows = kBoreRows;
    const auto [from, to] = besideAt(kBoreRows);
    shape.half = view_.is_cell ? static_cast<int>(std::ceil(view_.middle)) + 1 : to;
    return shape;
  }

  /// Columns beside the pipette, whose outline widens.
  std::pair<int, int> besideAt(int row) const {
    const double half = pipette_.half_width + std::max(0.0, pipette_.taper) * std::max(0, row - kBefore);
    const int from = static_cast<int>(kBesideFrom * half) + kBesideGap;
    return {from, from + static_cast<int>(kBeside * pipette_.half_width) + kBesideGap};
  }

  /// The best rim at each row that is no border which crosses the pipette.
  void search() {
    rows_best_.assign(static_cast<std::size_t>(rows_), {});
    for (int row = 0; row < rows_; ++row) rows_best_[static_cast<std::size_t>(row)].row = row;
    for (Eigen::VectorXd& side : beside_) side.resize(rows_);
    for (int row = 0; !view_.is_cell && row < rows_; ++row) {
      const auto [from, to] = besideAt(row);
      beside_[0][row] = meanOf(strip_, row, -to, -from);
      beside_[1][row] = meanOf(strip_, row, from, to);
    }
    for (const double width : kRims) {
      for (const double blur : kBlurs) {
        if (width <= view_.widest_rim && blur <= kMostBlur * width) searchFor(RimModel({width, blur}, view_, 0));
      }
    }
  }

  void searchFor(const RimModel& model) {
    const int first = model.shape().before() + kBefore + static_cast<int>(std::ceil(view_.mouth));
    const int last = rows_ - model.shape().after() - 1;
    std::array<std::vector<double>, 2> rims;  // seen beside the pipette
    for (int side = 0; side < 2 && !view_.is_cell; ++side) {
      rims[side].assign(static_cast<std::size_t>(rows_), 0.0);
      for (int row = model.shape().before(); row <= last; ++row)
        rims[side][row] = std::abs(model.at(beside_[side], row, noise_).rim);
    }
    for (int row = first; row <= last; ++row) {
      const RimModel::Fit fit = model.at(bore_, row, noise_);
      BoreCandidate& best = rows_best_[static_cast<std::size_t>(row)];
      if (fit.gain > best.fit.gain && (view_.is_cell || !crosses(model.shape(), rims, row, fit.rim)))
        best = {row, model.shape(), fit};
    }
  }

  /// Whether a line through a rim on one side, the row and a rim on the other is that of a border.
  bool crosses(const RimShape& shape, const std::array<std::vector<double>, 2>& rims, int row, double rim) const {
    if (rim < view_.least_rim) return false;
    const int reach = static_cast<int>(kSteepestCrossing * besideAt(row).second);
    const int bent = static_cast<int>(kBent + 0.5 * shape.width);
    const auto isRim = [&](const std::vector<double>& side, int at) {
      return at >= 0 && at < rows_ && side[at] > kCrossing * rim;
    };
    for (int away = -reach; away <= reach; ++away) {
      if (!isRim(rims[0], row - away)) continue;
      for (int bend = -bent; bend <= bent; ++bend) {
        if (isRim(rims[1], row + away + bend)) return true;
      }
    }
    return false;
  }

  /// The border that is farthest from the mouth: a column is full of granules, and behind it is nothing. Of a cell a
  /// clear one, since what is in a wide mouth may be faint. Models of several widths see one border at places that are
  /// a few rows apart.
  const BoreCandidate* farthest() const {
    auto last = std::find_if(rows_best_.rbegin(), rows_best_.rend(),
                             [&](const BoreCandidate& each) { return view_.is_cell && isClear(each); });
    if (last == rows_best_.rend())
      last = std::find_if(rows_best_.rbegin(), rows_best_.rend(),
                          [](const BoreCandidate& each) { return each.fit.gain > 0; });
    if (last == rows_best_.rend()) return nullptr;
    const BoreCandidate* best = &*last;
    for (auto other = last; other != rows_best_.rend() && last->row - other->row < view_.one_border; ++other) {
      if (other->fit.gain > best->fit.gain) best = &*other;
    }
    return best;
  }
  bool isClear(const BoreCandidate& candidate) const {
    return candidate.fit.rim >= view_.sure_rim && candidate.fit.clear >= kSureClear;
  }

  /// The largest rim beside the pipette, near a candidate's row.
  double besides(const BoreCandidate& best) const {
    if (view_.is_cell) return 0;
    const RimModel model(best.shape, view_, 0);
    const int reach = besideAt(best.row).second;
    const int first = std::max(best.shape.before(), best.row - reach);
    const int last = std::min(rows_ - best.shape.after() - 1, best.row + reach);
    double most = 0;
    for (const Eigen::VectorXd& side : beside_) {
      for (int row = first; row <= last; ++row) most = std::max(most, std::abs(model.at(side, row, noise_).rim));
    }
    return most;
  }

  void refine(const BoreCandidate& best, BoreBorder& found) const {
    double least = 1e300, offset = 0, curvature = 0, width = 0;
    for (const double wider : {0.75, 0.87, 1.0, 1.15, 1.32}) {
      for (const double softer : {0.7, 0.85, 1.0, 1.2, 1.45}) {
        const RimShape shape{wider * best.shape.width, softer * best.shape.blur};
        if (best.row < shape.before() || best.row + shape.after() >= rows_) continue;
        const auto at = [&](double shift) {
          return RimModel(shape, view_, shift).at(bore_, best.row, noise_).residual;
        };
        // Windows of other rims have other numbers of rows.
        const auto freedom = static_cast<double>(shape.before() + shape.after() - 4);
        const double step = 0.25;
        for (double shift = -1.5; shift <= 1.5; shift += step) {
          const double low = at(shift - step), middle = at(shift), high = at(shift + step);
          if (middle > low || middle > high || middle / freedom >= least) continue;
          const double bend = (low - 2 * middle + high) / (step * step);
          least = middle / freedom;
          offset = bend > 0 ? shift - 0.5 * (high - low) / (2 * step) / (0.5 * bend) : shift;
          curvature = bend;
          width = shape.width;
        }
      }
    }
    if (!(curvature > 0)) {
      found.finding = Finding::uncertain("the border in the bore is blurred");
      found.deviation = best.shape.width;
    } else {
      found.finding = Finding::found();
      const double variance = std::max(noise_ * noise_, least);
      found.deviation = std::sqrt(2 * variance / curvature + kModel * kModel + std::pow(kFlatness * view_.middle, 2) +
                                  std::pow(0.02 * width, 2) + std::pow(pipette_.deviationAlong(), 2));
    }
    found.length = best.row + offset - kBefore;
    found.place = strip_.point(best.row + offset, 0);
  }

  const PipetteDetection& pipette_;
  const BoreView& view_;
  PipetteStrip strip_;
  int rows_ = 0;  ///< within the image
  Eigen::VectorXd bore_;
  std::array<Eigen::VectorXd, 2> beside_;  ///< means of each row, beside the pipette
  double noise_ = 0;
  std::vector<BoreCandidate> rows_best_;
};

}  // namespace

BoreBorder findBoreBorder(const Frame& frame, const PipetteDetection& pipette, const BoreView& view) {
  BoreBorder none;
  none.finding = Finding::notFound(frame.refusal().empty() ? "no pipette was found" : frame.refusal());
  if (!frame.refusal().empty() || !pipette.finding.hasValues()) return none;
  return BoreSearch(frame, pipette, view).find();
}

BoreBorder findColumn(const Frame& frame, const PipetteDetection& injection) {
  BoreBorder none;
  none.finding = Finding::notFound("the needle is too thin for its bore to be seen");
  if (injection.finding.hasValues() && injection.half_width < kThinnestNeedle) return none;
  BoreView view;
  view.middle = 0.22 * injection.half_width;
  view.mouth = 0.4 * injection.half_width;
  view.widest_rim = 14;
  view.one_border = 18;
  view.least_rim = 0.05;
  view.sure_rim = 0.1;
  return findBoreBorder(frame, injection, view);
}

BoreBorder findTongue(const Frame& frame, const PipetteDetection& holding, bool has_zona) {
  BoreView view;
  view.middle = 0.06 * holding.half_width;
  view.place = has_zona ? 0.5 : 1;
  view.mouth = 0.05 * holding.half_width + 2;
  view.widest_rim = 7;
  view.one_border = 8;
  view.least_rim = 0.02;
  view.sure_rim = 0.03;
  view.has_line = false;
  view.is_cell = true;
  return findBoreBorder(frame, holding, view);
}

}  // namespace microinjection
