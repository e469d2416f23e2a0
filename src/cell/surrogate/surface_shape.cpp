#include "cell/surrogate/surface_shape.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

double cube(double x) { return x * x * x; }

/// Interpolation by radial basis functions r^3 with a linear part. `centres` has a column for each
/// of n points in d dimensions.
///
/// Values of the functions at a point: of each centre, then 1 and the coordinates (n + 1 + d).
Eigen::VectorXd radialBasis(const Eigen::MatrixXd& centres, const Eigen::VectorXd& at) {
  const Eigen::Index count = centres.cols();
  Eigen::VectorXd values(count + 1 + centres.rows());
  for (Eigen::Index i = 0; i < count; ++i) values[i] = cube((centres.col(i) - at).norm());
  values[count] = 1;
  values.tail(centres.rows()) = at;
  return values;
}

/// Weights (n + 1 + d rows) of the functions, for each column of `values` (n rows) at the centres.
Eigen::MatrixXd radialWeights(const Eigen::MatrixXd& centres, const Eigen::MatrixXd& values) {
  const Eigen::Index count = centres.cols(), size = count + 1 + centres.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size), right = Eigen::MatrixXd::Zero(size, values.cols());
  for (Eigen::Index i = 0; i < count; ++i) system.row(i) = radialBasis(centres, centres.col(i)).transpose();
  system.bottomLeftCorner(size - count, count) = system.topRightCorner(count, size - count).transpose();
  right.topRows(count) = values;
  return system.partialPivLu().solve(right);
}

constexpr Eigen::Index kModes = 40;
constexpr double kNegligible = 1e-10;  ///< eigenvalue, relative to the largest: 1e-5 of the motion

Eigen::Index entries() { return 3 * static_cast<Eigen::Index>(SurfaceGrid::standard().nodeCount()); }

void writeMatrix(ByteWriter& writer, const Eigen::MatrixXd& matrix) {
  writer.number<std::int64_t>(matrix.rows());
  writer.array(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size())));
}

Eigen::MatrixXd readMatrix(ByteReader& reader) {
  const auto rows = reader.number<std::int64_t>();
  Eigen::VectorXd values;
  reader.array(values);
  if (rows <= 0 || values.size() % rows != 0) throw std::runtime_error("a matrix has no whole columns");
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, values.size() / rows);
}

}  // namespace

Eigen::Vector4d contactVariables(const SurrogateRange& range, double angle, const Eigen::Vector3d& displacement) {
  return {angle / range.angle, displacement.x() / range.lateral, displacement.y() / range.lateral,
          -displacement.z() / range.depth};
}

SurfaceShape::SurfaceShape(const SurrogateRange& range, double radius, const std::vector<double>& angles,
                           const std::vector<TrainingSample>& samples)
    : range_(range), radius_(radius) {
  const auto count = static_cast<Eigen::Index>(samples.size()), at_rest = static_cast<Eigen::Index>(angles.size());
  Eigen::MatrixXd snapshots(entries(), count);
  centres_.resize(4, count + at_rest);
  for (Eigen::Index i = 0; i < count; ++i) {
    if (samples[i].surface.size() != entries()) throw std::invalid_argument("SurfaceShape: a sample of another grid");
    snapshots.col(i) = samples[i].surface.cast<double>();
    centres_.col(i) = contactVariables(range, samples[i].angle, samples[i].displacement);
  }
  for (Eigen::Index i = 0; i < at_rest; ++i) {
    centres_.col(count + i) = contactVariables(range, angles[i], Eigen::Vector3d::Zero());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(snapshots.transpose() * snapshots);
  const double negligible = kNegligible * eigen.eigenvalues().tail(1).value();
  const Eigen::Index significant = (eigen.eigenvalues().array() > negligible).count();
  const Eigen::Index modes = std::min(kModes, significant);
  const Eigen::MatrixXd basis = snapshots * eigen.eigenvectors().rightCols(modes) *
                                eigen.eigenvalues().tail(modes).cwiseSqrt().cwiseInverse().asDiagonal();
  modes_ = basis.cast<float>();
  Eigen::MatrixXd amplitudes = Eigen::MatrixXd::Zero(count + at_rest, modes);
  amplitudes.topRows(count) = snapshots.transpose() * basis;
  weights_ = radialWeights(centres_, amplitudes);
}

SurfaceShape::SurfaceShape(const SurrogateRange& range, double radius, const Eigen::MatrixXd& centres,
                           const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXf& modes)
    : range_(range), radius_(radius), centres_(centres), weights_(radialWeights(centres, amplitudes)), modes_(modes) {
  if (!consistent()) throw std::invalid_argument("SurfaceShape: sizes do not fit");
}

void SurfaceShape::changeUnit(double length) {
  range_ = range_.scaled(length);
  radius_ *= length;
  modes_ = (length * modes_.cast<double>()).cast<float>();
}

void SurfaceShape::evaluate(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& at_rest,
                            Eigen::VectorXd& displaced) const {
  at_rest = SurfaceGrid::standard().nodes(radius_, angle);
  displaced.setZero(at_rest.size());
  if (modes_.size() == 0) return;
  const bool turned = displacement.y() < 0;
  const Eigen::Vector3d in_half(displacement.x(), std::abs(displacement.y()), displacement.z());
  const Eigen::VectorXd amplitudes =
      weights_.transpose() * radialBasis(centres_, contactVariables(range_, angle, in_half));
  const Eigen::VectorXd field = (modes_ * amplitudes.cast<float>()).cast<double>();
  displaced = field;
  if (!turned) return;
  const std::vector<int>& mirrored = SurfaceGrid::standard().mirrored();
  for (std::size_t n = 0; n < mirrored.size(); ++n) {
    displaced.segment<3>(3 * static_cast<Eigen::Index>(n)) = field.segment<3>(3 * mirrored[n]);
    displaced[3 * static_cast<Eigen::Index>(n) + 1] *= -1;
  }
}

void SurfaceShape::write(ByteWriter& writer) const {
  for (double x : {range_.angle, range_.depth, range_.axis_depth, range_.lateral, radius_}) writer.number(x);
  for (const Eigen::MatrixXd* matrix : {&centres_, &weights_}) writeMatrix(writer, *matrix);
  writeMatrix(writer, modes_.cast<double>());
}

SurfaceShape SurfaceShape::read(ByteReader& reader) {
  SurfaceShape shape;
  SurrogateRange& range = shape.range_;
  for (double* x : {&range.angle, &range.depth, &range.axis_depth, &range.lateral, &shape.radius_}) {
    *x = reader.number<double>();
  }
  for (Eigen::MatrixXd* matrix : {&shape.centres_, &shape.weights_}) *matrix = readMatrix(reader);
  shape.modes_ = readMatrix(reader).cast<float>();
  if (!shape.consistent()) throw std::runtime_error("the surface's sizes do not fit");
  if (!shape.finite()) throw std::runtime_error("a value of the surface is not finite");
  return shape;
}

bool SurfaceShape::consistent() const {
  return modes_.rows() == entries() && centres_.rows() == 4 && weights_.rows() == centres_.cols() + 5 &&
         weights_.cols() == modes_.cols();
}

bool SurfaceShape::finite() const {
  const double sizes[] = {range_.angle, range_.depth, range_.axis_depth, range_.lateral, radius_};
  const auto positive = [](double size) { return std::isfinite(size) && size > 0; };
  return std::all_of(std::begin(sizes), std::end(sizes), positive) && centres_.allFinite() && weights_.allFinite() &&
         modes_.allFinite();
}

}  // namespace microinjection
