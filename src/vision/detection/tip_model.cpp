#include "vision/detection/tip_model.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kMostRows = 96, kMostTerms = 5, kMostShared = 3;
constexpr double kScale = 12;  // rows, in which powers of s are of the size of 1
constexpr int kFaceRows = 6;   // behind the end, that show the outline

double stepAt(double s) { return 0.5 * std::erfc(-s / std::sqrt(2.0)); }

using Column = std::array<float, kMostRows>;

float product(const float* a, const float* b, int rows) {
  float sum = 0;
  for (int i = 0; i < rows; ++i) sum += a[i] * b[i];
  return sum;
}

/// Terms that each column has with a factor of its own. They are orthonormal.
class OwnTerms {
 public:
  OwnTerms(const TipWindow& window, const TipModel& model, double end, double blur)
      : rows_(window.rows()), count_(model.terms()) {
    for (int i = 0; i < rows_; ++i) {
      const double s = (window.first() + i - end) / blur, step = stepAt(s), far = s * blur / kScale;
      terms_[0][i] = static_cast<float>(step);
      terms_[1][i] = static_cast<float>(far * step);
      terms_[2][i] = static_cast<float>(far * far * step);
      if (!model.fringes) continue;
      const double bell = std::exp(-0.5 * s * s);
      terms_[3][i] = static_cast<float>(s * bell);
      terms_[4][i] = static_cast<float>((s * s * s - 3 * s) * bell);
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
  std::array<Column, kMostTerms> terms_;
};

/// Terms that all columns share, beside their own ones: normal equations for their few factors.
class SharedTerms {
 public:
  SharedTerms(const TipWindow& window, const OwnTerms& own) : window_(window), own_(own) {}

  /// @param across  factor of each column; it must outlive this object
  void add(const Column& along, const std::vector<double>& across) {
    along_[count_] = along;
    own_.remove(along_[count_]);
    across_[count_] = &across;
    right_[count_] = 0;
    for (int t = 0; t < window_.columns(); ++t)
      right_[count_] +=
          window_.weight(t) * across[t] * product(along_[count_].data(), window_.column(t), window_.rows());
    for (int i = 0; i <= count_; ++i) {
      double sum = 0;
      for (int t = 0; t < window_.columns(); ++t) sum += window_.weight(t) * (*across_[i])[t] * across[t];
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
  std::array<Column, kMostShared> along_;
  std::array<const std::vector<double>*, kMostShared> across_{};
  std::array<std::array<double, kMostShared>, kMostShared> matrix_{};
  std::array<double, kMostShared> right_{};
};

}  // namespace

TipWindow::TipWindow(const PipetteStrip& strip, int first, int last, int columns)
    : first_(first), rows_(std::min(last - first, kMostRows)), columns_(columns) {
  double mean = 0;
  for (int t = 0; t < columns_; ++t) {
    for (int row = first_; row < first_ + rows_; ++row) {
      const float* grey = strip.grey().ptr<float>(row) + strip.half();
      grey_.push_back(0.5F * (grey[t] + grey[-t]));
      mean += grey_.back() / (columns_ * rows_);
    }
  }
  // Numbers near zero are exact in single precision.
  for (float& grey : grey_) grey -= static_cast<float>(mean);
  const auto extremes = std::minmax_element(grey_.begin(), grey_.end());
  range_ = *extremes.second - *extremes.first;
  for (int t = 0; t < columns_; ++t) squares_.push_back(product(column(t), column(t), rows_));
}

std::vector<double> endFace(const TipWindow& window, double end, double blur) {
  const int behind = std::clamp(static_cast<int>(end + 2 + blur) - window.first(), 0, window.rows() - kFaceRows);
  const int before = std::clamp(static_cast<int>(end - 4 - 2 * blur) - window.first(), 0, window.rows() - 4);
  std::vector<double> size;
  for (int t = 0; t < window.columns(); ++t) {
    double sum = 0;
    for (int i = behind; i < behind + kFaceRows; ++i) sum += window.column(t)[i] / kFaceRows;
    for (int i = before; i < before + 4; ++i) sum -= window.column(t)[i] / 4;
    size.push_back(std::abs(sum));
  }
  // The outline is where the profile, seen from outside, has half of its largest size.
  const double half = 0.5 * *std::max_element(size.begin(), size.end());
  int outer = window.columns() - 1;
  while (outer > 0 && size[outer] < half) --outer;
  double radius = outer;
  if (outer + 1 < window.columns()) radius += (size[outer] - half) / std::max(size[outer] - size[outer + 1], 1e-9);
  std::vector<double> face;
  for (int t = 0; t < window.columns(); ++t) face.push_back(stepAt((radius - t) / blur) - stepAt((-radius - t) / blur));
  return face;
}

std::vector<double> tipResiduals(const TipWindow& window, const TipModel& model, double end, double blur,
                                 const std::vector<double>& face, const std::vector<double>& rims) {
  const OwnTerms own(window, model, end, blur);
  double rest = 0;
  for (int t = 0; t < window.columns(); ++t)
    rest += window.weight(t) * (window.square(t) - own.explained(window.column(t)));
  const std::vector<double> ones(window.columns(), 1.0);
  SharedTerms shared(window, own);
  Column values{};
  values.fill(1);
  shared.add(values, ones);
  for (int i = 0; i < window.rows(); ++i) values[i] = static_cast<float>(i) / static_cast<float>(window.rows()) - 0.5F;
  shared.add(values, ones);
  double last = 0;
  const double plain = rest - shared.explained(last);
  std::vector<double> result;
  for (const double rim : rims) {
    result.push_back(plain);
    if (!(rim > 0)) continue;
    for (int i = 0; i < window.rows(); ++i) {
      const double s = window.first() + i - end;
      values[i] = static_cast<float>(stepAt(s / blur) - stepAt((s - rim) / blur));
    }
    shared.add(values, face);
    const double value = rest - shared.explained(last);
    if (last < 0) result.back() = value;
    shared.dropLast();
  }
  return result;
}

}  // namespace microinjection
