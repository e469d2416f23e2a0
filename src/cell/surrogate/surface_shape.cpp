#include "cell/surrogate/surface_shape.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr Eigen::Index kModes = 40;
constexpr double kNegligible = 1e-10;  ///< eigenvalue, relative to the largest: 1e-5 of the motion

double cube(double x) { return x * x * x; }

/// For each node, the node at its mirror image in y.
std::vector<int> mirror(const Eigen::VectorXd& nodes) {
  const int count = static_cast<int>(nodes.size() / 3);
  std::vector<int> result(count);
  const Eigen::Map<const Eigen::Matrix3Xd> positions(nodes.data(), 3, count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d image(positions(0, i), -positions(1, i), positions(2, i));
    (positions.colwise() - image).colwise().squaredNorm().minCoeff(&result[i]);
  }
  return result;
}

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

SurfaceShape::SurfaceShape(const PreparationRange& range, const std::vector<double>& angles,
                           const std::vector<TrainingSurface>& surfaces, const std::vector<TrainingSample>& samples)
    : range_(range), node_count_(surfaces.front().nodes.size() / 3), triangles_(surfaces.front().triangles) {
  for (const TrainingSample& sample : samples) {
    if (sample.surface.size() != 3 * node_count_) throw std::invalid_argument("SurfaceShape: a sample of another mesh");
  }
  angles_ = Eigen::Map<const Eigen::VectorXd>(angles.data(), static_cast<Eigen::Index>(angles.size()));
  rest_.resize(3 * node_count_, angles_.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) rest_.col(static_cast<Eigen::Index>(i)) = surfaces[i].nodes;
  mirrored_ = mirror(surfaces.front().nodes);

  // Both halves of the range, and the cell at rest.
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd snapshots(3 * node_count_, count);
  centres_.resize(4, count + angles_.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    snapshots.col(i) = samples[i].surface.cast<double>();
    centres_.col(i) = variables(samples[i].angle, samples[i].displacement);
  }
  for (Eigen::Index i = 0; i < angles_.size(); ++i) {
    centres_.col(count + i) = variables(angles_[i], Eigen::Vector3d::Zero());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(snapshots.transpose() * snapshots);
  const double negligible = kNegligible * eigen.eigenvalues().tail(1).value();
  const Eigen::Index significant = (eigen.eigenvalues().array() > negligible).count();
  const Eigen::Index modes = std::min(kModes, significant);
  const Eigen::MatrixXd basis = snapshots * eigen.eigenvectors().rightCols(modes) *
                                eigen.eigenvalues().tail(modes).cwiseSqrt().cwiseInverse().asDiagonal();
  modes_ = basis.cast<float>();

  const Eigen::Index size = centres_.cols();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size + 5, size + 5);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j < size; ++j) system(i, j) = cube((centres_.col(i) - centres_.col(j)).norm());
    system(i, size) = system(size, i) = 1;
    system.block<1, 4>(i, size + 1) = centres_.col(i).transpose();
    system.block<4, 1>(size + 1, i) = centres_.col(i);
  }
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(size + 5, modes);
  right.topRows(count) = snapshots.transpose() * basis;
  weights_ = system.partialPivLu().solve(right);
}

void SurfaceShape::changeUnit(double length) {
  range_ = range_.scaled(length);
  rest_ *= length;
  modes_ = (length * modes_.cast<double>()).cast<float>();
}

Eigen::Vector4d SurfaceShape::variables(double angle, const Eigen::Vector3d& displacement) const {
  return {angle / range_.angle, displacement.x() / range_.lateral, displacement.y() / range_.lateral,
          -displacement.z() / range_.depth};
}

Eigen::VectorXd SurfaceShape::amplitudes(const Eigen::Vector4d& at) const {
  const Eigen::Index size = centres_.cols();
  Eigen::VectorXd basis(size + 5);
  for (Eigen::Index i = 0; i < size; ++i) basis[i] = cube((centres_.col(i) - at).norm());
  basis[size] = 1;
  basis.tail<4>() = at;
  return weights_.transpose() * basis;
}

void SurfaceShape::evaluate(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& at_rest,
                            Eigen::VectorXd& displaced) const {
  at_rest = Eigen::VectorXd::Zero(3 * node_count_);
  for (Eigen::Index i = 0; i < angles_.size(); ++i) {  // Lagrange's polynomial in the angle
    double weight = 1;
    for (Eigen::Index j = 0; j < angles_.size(); ++j) {
      if (j != i) weight *= (angle - angles_[j]) / (angles_[i] - angles_[j]);
    }
    at_rest += weight * rest_.col(i);
  }
  const bool turned = displacement.y() < 0;
  const Eigen::Vector3d in_half(displacement.x(), std::abs(displacement.y()), displacement.z());
  const Eigen::VectorXd field = (modes_ * amplitudes(variables(angle, in_half)).cast<float>()).cast<double>();
  displaced = field;
  for (std::int64_t n = 0; turned && n < node_count_; ++n) {
    displaced.segment<3>(3 * n) = field.segment<3>(3 * mirrored_[n]);
    displaced[3 * n + 1] *= -1;
  }
}

void SurfaceShape::write(ByteWriter& writer) const {
  for (double x : {range_.angle, range_.depth, range_.axis_depth, range_.lateral}) writer.number(x);
  writer.number(node_count_);
  std::vector<int> corners;
  for (const Eigen::Vector3i& triangle : triangles_)
    corners.insert(corners.end(), triangle.data(), triangle.data() + 3);
  writer.array(corners);
  writer.array(mirrored_);
  writer.array(angles_);
  for (const Eigen::MatrixXd* matrix : {&rest_, &centres_, &weights_}) writeMatrix(writer, *matrix);
  writeMatrix(writer, modes_.cast<double>());
}

SurfaceShape SurfaceShape::read(ByteReader& reader) {
  SurfaceShape shape;
  PreparationRange& range = shape.range_;
  for (double* x : {&range.angle, &range.depth, &range.axis_depth, &range.lateral}) {
    *x = reader.number<double>();
  }
  shape.node_count_ = reader.number<std::int64_t>();
  std::vector<int> corners;
  reader.array(corners);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    shape.triangles_.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  }
  reader.array(shape.mirrored_);
  reader.array(shape.angles_);
  for (Eigen::MatrixXd* matrix : {&shape.rest_, &shape.centres_, &shape.weights_}) *matrix = readMatrix(reader);
  shape.modes_ = readMatrix(reader).cast<float>();
  if (corners.size() % 3 != 0 || !shape.consistent()) throw std::runtime_error("the surface's sizes do not fit");
  if (!shape.finite()) throw std::runtime_error("a value of the surface is not finite");
  return shape;
}

bool SurfaceShape::consistent() const {
  const auto isNode = [&](int node) { return node >= 0 && node < node_count_; };
  const auto areNodes = [&](const Eigen::Vector3i& corners) {
    return std::all_of(corners.data(), corners.data() + 3, isNode);
  };
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(mirrored_.size());
  return node_count_ > 0 && static_cast<std::uint64_t>(node_count_) == mirrored_.size() &&
         std::all_of(mirrored_.begin(), mirrored_.end(), isNode) &&
         std::all_of(triangles_.begin(), triangles_.end(), areNodes) && angles_.size() > 0 &&
         rest_.cols() == angles_.size() && rest_.rows() == rows && modes_.rows() == rows && centres_.rows() == 4 &&
         weights_.rows() == centres_.cols() + 5 && weights_.cols() == modes_.cols();
}

bool SurfaceShape::finite() const {
  const double sizes[] = {range_.angle, range_.depth, range_.axis_depth, range_.lateral};
  const auto positive = [](double size) { return std::isfinite(size) && size > 0; };
  // Equal angles would divide by zero.
  const double *first = angles_.data(), *last = first + angles_.size();
  const bool ascending = std::adjacent_find(first, last, std::greater_equal<double>()) == last;
  return std::all_of(std::begin(sizes), std::end(sizes), positive) && angles_.allFinite() && ascending &&
         rest_.allFinite() && centres_.allFinite() && weights_.allFinite() && modes_.allFinite();
}

}  // namespace microinjection
