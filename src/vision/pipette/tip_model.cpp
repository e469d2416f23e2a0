#include "vision/pipette/tip_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "vision/pipette/tip_edge.h"

namespace microinjection {
namespace {

constexpr int kMostRows = TipWindow::kMostRows, kMostTerms = 4, kMostShared = 4;
constexpr int kLanes = 8;               // sums that a processor makes at a time
constexpr double kScale = 12;           // rows, in which powers of s are of the size of 1
constexpr int kNarrower = 3;            // columns
constexpr double kThinnestOutline = 2;  // columns, half width of an outline
constexpr int kFaceRows = 6;            // behind the end, that show the outline
constexpr double kLeastWall = 0.2;      // size of the profile at a wall over its largest, at least
constexpr double kWidestWall = 0.5, kLeastRim = 0.9, kFaceBlur = 1.5;  // of the radius; rows; of the blur

double stepAt(double s) { return 0.5 * std::erfc(-s / std::sqrt(2.0)); }

using Column = std::array<float, kMostRows>;

/// Behind the last row all values are 0.
float product(const float* a, const float* b, int rows) {
  std::array<float, kLanes> sums{};
  for (int i = 0; i < rows; i += kLanes) {
    for (int k = 0; k < kLanes; ++k) sums[k] += a[i + k] * b[i + k];
  }
  float sum = 0;
  for (const float lane : sums) sum += lane;
  return sum;
}

/// Terms that each column has with a factor of its own. They are orthonormal.
class OwnTerms {
 public:
  OwnTerms(const TipWindow& window, const TipModel& model, double end) : rows_(window.rows()), count_(termsOf(model)) {
    const TipEdge edge(model.blur, model.fringes);
    for (int i = 0; i < rows_; ++i) {
      const double s = window.first() + i - end, far = s / kScale;
      const std::complex<float> value = edge.at(s);
      step_[i] = terms_[0][i] = value.real();
      terms_[1][i] = static_cast<float>(far) * value.real();
      terms_[2][i] = static_cast<float>(far * far) * value.real();
      if (model.fringes > 0) terms_[3][i] = value.imag();
    }
    for (int k = 0; k < count_; ++k) {
      // Once more, because single precision leaves a rest of nearly parallel terms.
      remove(terms_[k], k);
      remove(terms_[k], k);
      const float square = product(terms_[k].data(), terms_[k].data(), rows_);
      const float scale = square > 1e-6F ? 1 / std::sqrt(square) : 0;
      for (int i = 0; i < rows_; ++i) terms_[k][i] *= scale;
    }
  }
  const Column& step() const { return step_; }  ///< real part of the edge
  void remove(Column& values) const { remove(values, count_); }
  /// Of a column, what the terms explain of its squares.
  double explained(const float* column) const {
    double sum = 0;
    for (int k = 0; k < count_; ++k) sum += std::pow(product(terms_[k].data(), column, rows_), 2);
    return sum;
  }

 private:
  void remove(Column& values, int count) const {
    for (int k = 0; k < count; ++k) {
      const float dot = product(values.data(), terms_[k].data(), rows_);
      for (int i = 0; i < rows_; ++i) values[i] -= dot * terms_[k][i];
    }
  }

  int rows_, count_;
  Column step_{};
  std::array<Column, kMostTerms> terms_{};
};

/// Terms that all columns share, beside their own ones: normal equations for their few factors.
class SharedTerms {
 public:
  SharedTerms(const TipWindow& window, const OwnTerms& own) : window_(window), own_(own) {}

  /// `across` must outlive this object.
  void add(const Column& along, const SharedColumns& across) {
    along_[count_] = along;
    own_.remove(along_[count_]);
    across_[count_] = &across;
    right_[count_] = product(along_[count_].data(), across.sum.data(), window_.rows());
    for (int i = 0; i <= count_; ++i) {
      double sum = 0;
      for (int t = 0; t < window_.columns(); ++t) sum += window_.weight(t) * across_[i]->factor[t] * across.factor[t];
      matrix_[count_][i] = matrix_[i][count_] =
          sum * product(along_[i].data(), along_[count_].data(), window_.rows()) * (i == count_ ? 1 + 1e-6 : 1);
    }
    ++count_;
  }
  void dropLast() { --count_; }

  /// What they explain of the squares; the factor of the last one is a result.
  double explained(double& last) const {
    std::array<std::array<double, kMostShared>, kMostShared> m = matrix_;
    std::array<double, kMostShared> right = right_;
    for (int i = 0; i < count_; ++i) {
      for (int k = i + 1; k < count_; ++k) {
        const double factor = m[i][i] > 1e-12 ? m[k][i] / m[i][i] : 0;
        for (int j = i; j < count_; ++j) m[k][j] -= factor * m[i][j];
        right[k] -= factor * right[i];
      }
    }
    std::array<double, kMostShared> x{};
    double sum = 0;
    for (int i = count_ - 1; i >= 0; --i) {
      double value = right[i];
      for (int j = i + 1; j < count_; ++j) value -= m[i][j] * x[j];
      x[i] = m[i][i] > 1e-12 ? value / m[i][i] : 0;
      sum += x[i] * right_[i];
    }
    last = x[count_ - 1];
    return sum;
  }

 private:
  const TipWindow& window_;
  const OwnTerms& own_;
  int count_ = 0;
  std::array<Column, kMostShared> along_{};
  std::array<const SharedColumns*, kMostShared> across_{};
  std::array<std::array<double, kMostShared>, kMostShared> matrix_{};
  std::array<double, kMostShared> right_{};
};

}  // namespace

TipWindow::TipWindow(const PipetteStrip& strip, int first, int last, int columns, const TipOutline& outline, double end)
    : first_(first), rows_(std::min(last - first, kMostRows)), columns_(columns) {
  double mean = 0;
  grey_.assign(static_cast<std::size_t>(columns_) * kMostRows, 0.0F);
  const double growth = outline.valid ? outline.growth / std::max(outline.half_width, kThinnestOutline) : 0;
  for (int i = 0; i < rows_; ++i) {
    const float* grey = strip.grey().ptr<float>(first_ + i) + strip.half();
    const double widening = 1 + growth * std::max(0.0, first_ + i - end);
    for (int t = 0; t < columns_; ++t) {
      const double place = std::min(t * widening, strip.half() - 1.001);
      const int k = static_cast<int>(place);
      const auto share = static_cast<float>(place - k);
      grey_[t * kMostRows + i] = 0.5F * ((1 - share) * (grey[k] + grey[-k]) + share * (grey[k + 1] + grey[-k - 1]));
      mean += grey_[t * kMostRows + i] / (columns_ * rows_);
    }
  }
  // Numbers near zero are exact in single precision.
  float least = 1e9F, largest = -least;
  for (int t = 0; t < columns_; ++t) {
    for (int i = 0; i < rows_; ++i) {
      float& grey = grey_[t * kMostRows + i];
      grey -= static_cast<float>(mean);
      least = std::min(least, grey);
      largest = std::max(largest, grey);
    }
    squares_.push_back(product(column(t), column(t), rows_));
  }
  range_ = largest - least;
  all_ = sharedBy(std::vector<double>(columns_, 1.0));
}

SharedColumns TipWindow::sharedBy(std::vector<double> factor) const {
  SharedColumns shared{std::move(factor), std::vector<float>(kMostRows, 0.0F)};
  for (int t = 0; t < columns_; ++t) {
    const auto share = static_cast<float>(weight(t) * shared.factor[t]);
    for (int i = 0; i < rows_; ++i) shared.sum[i] += share * column(t)[i];
  }
  return shared;
}

int termsOf(const TipModel& model) { return model.fringes > 0 ? 4 : 3; }

EndFace::EndFace(const TipWindow& window, double end, double blur) {
  const int behind = std::clamp(static_cast<int>(end + 2 + blur) - window.first(), 0, window.rows() - kFaceRows);
  const int before = std::clamp(static_cast<int>(end - 4 - 2 * blur) - window.first(), 0, window.rows() - 4);
  std::vector<double> size;
  for (int t = 0; t < window.columns(); ++t) {
    double sum = 0;
    for (int i = behind; i < behind + kFaceRows; ++i) sum += window.column(t)[i] / kFaceRows;
    for (int i = before; i < before + 4; ++i) sum -= window.column(t)[i] / 4;
    size.push_back(std::abs(sum));
  }
  // The outline is where the profile, seen from outside, has half of its size at the wall. A bright core may be far
  // larger than that.
  const double least = kLeastWall * *std::max_element(size.begin(), size.end());
  int wall = window.columns() - 1;
  while (wall > 0 && (size[wall] < least || size[wall - 1] > size[wall])) --wall;
  const double half = 0.5 * size[wall];
  int outer = wall;
  while (outer + 1 < window.columns() && size[outer + 1] >= half) ++outer;
  double radius = outer;
  if (outer + 1 < window.columns()) radius += (size[outer] - half) / std::max(size[outer] - size[outer + 1], 1e-9);
  // The blur widens the outline of a thin tube.
  widest_rim = std::max(kLeastRim, kWidestWall * (radius - kFaceBlur * blur));
  std::vector<double> face;
  for (int t = 0; t < window.columns(); ++t) face.push_back(stepAt((radius - t) / blur) - stepAt((-radius - t) / blur));
  whole = window.sharedBy(face);
  face.erase(face.begin(), face.begin() + std::min<std::ptrdiff_t>(kNarrower, face.size()));
  face.resize(window.columns(), 0.0);
  narrower = window.sharedBy(std::move(face));
}

std::vector<double> tipResiduals(const TipWindow& window, const TipModel& model, double end, const EndFace& face,
                                 const std::vector<double>& rims) {
  const OwnTerms own(window, model, end);
  double rest = 0;
  for (int t = 0; t < window.columns(); ++t)
    rest += window.weight(t) * (window.square(t) - own.explained(window.column(t)));
  SharedTerms shared(window, own);
  Column values{};
  std::fill_n(values.begin(), window.rows(), 1.0F);
  shared.add(values, window.all());
  for (int i = 0; i < window.rows(); ++i) values[i] = static_cast<float>(i) / static_cast<float>(window.rows()) - 0.5F;
  shared.add(values, window.all());
  double last = 0;
  const double plain = rest - shared.explained(last);
  std::vector<double> result;
  const TipEdge edge(model.blur, model.fringes);
  for (const double rim : rims) {
    result.push_back(plain);
    if (!(rim > 0)) continue;
    for (int i = 0; i < window.rows(); ++i) {
      const double s = window.first() + i - end;
      values[i] = own.step()[i] - edge.at(s - rim).real();
    }
    shared.add(values, face.whole);
    const double value = rest - shared.explained(last);
    if (last < 0) result.back() = value;
    if (last < 0 && model.fringes > 0) {
      // Becke's line displaces the outline, and with it the face.
      shared.add(values, face.narrower);
      result.back() = rest - shared.explained(last);
      shared.dropLast();
    }
    shared.dropLast();
  }
  return result;
}

}  // namespace microinjection
