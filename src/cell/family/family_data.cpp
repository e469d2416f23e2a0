#include "cell/family/family_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "base/bytes.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_places.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr double kLargestError = 0.1;  ///< expected at one of ten places of a cell that is served

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

ExpectedError quantiles(const std::vector<double>& values) { return {quantile(values, 0.5), quantile(values, 0.9)}; }

constexpr char kVersion[] = " data 3";  ///< change it when the format or the fit of a member changes
constexpr int kMostMembers = 1000;

void writeMember(ByteWriter& writer, const FamilyMember& member, const Eigen::MatrixXf& surface) {
  writer.array(member.coordinates);
  for (const double x :
       {member.reached.share, member.reached.axis_share, member.scale, member.median_error, member.common_error}) {
    writer.number(x);
  }
  writer.array(member.energy);
  writer.array(member.field);
  writer.array(Eigen::VectorXf(Eigen::Map<const Eigen::VectorXf>(surface.data(), surface.size())));
}

template <typename Vector>
Vector readVector(ByteReader& reader, Eigen::Index size) {
  Vector values;
  reader.array(values);
  if (values.size() != size) throw std::runtime_error("a size cannot be");
  if (!values.allFinite()) throw std::runtime_error("a value is not finite");
  return values;
}

Eigen::MatrixXf readSurface(ByteReader& reader, Eigen::Index rows, Eigen::Index columns) {
  const auto values = readVector<Eigen::VectorXf>(reader, rows * columns);
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), rows, columns);
}

FamilyMember readMember(ByteReader& reader, Eigen::Index dimension) {
  const Eigen::Index energy = EnergyExpansion(EnergyScales(), EnergyDegrees()).size();
  const Eigen::Index field = ForceField(EnergyScales()).coefficients().size();
  FamilyMember member;
  member.coordinates = readVector<Eigen::VectorXd>(reader, dimension);
  for (double* x :
       {&member.reached.share, &member.reached.axis_share, &member.scale, &member.median_error, &member.common_error}) {
    *x = reader.number<double>();
    if (!(std::isfinite(*x) && *x >= 0)) throw std::runtime_error("a number of a member cannot be");
  }
  if (!(member.scale > 0 && member.reached.share > 0 && member.reached.axis_share > 0)) {
    throw std::runtime_error("a number of a member cannot be");
  }
  member.energy = readVector<Eigen::VectorXd>(reader, energy);
  member.field = readVector<Eigen::VectorXd>(reader, field);
  return member;
}

MeasuredError readMeasuredError(ByteReader& reader) {
  MeasuredError measured;
  measured.members = reader.number<std::int32_t>();
  if (measured.members < 0 || measured.members > kMostMembers)
    throw std::runtime_error("a number of members cannot be");
  for (double* x : {&measured.error.median, &measured.error.common, &measured.deviation}) {
    *x = reader.number<double>();
    if (!(std::isfinite(*x) && *x >= 0)) throw std::runtime_error("a measured error cannot be");
  }
  return measured;
}

std::uint64_t readCount(ByteReader& reader) {
  const auto count = reader.number<std::uint64_t>();
  if (count > kMostMembers) throw std::runtime_error("a number of members cannot be");
  return count;
}

}  // namespace

void FamilyData::add(const FamilyMember& member, const Eigen::MatrixXf& displacements) {
  members_.push_back(member);
  surfaces_.add(displacements);
  kriging_.reset();
}

Eigen::MatrixXd FamilyData::points() const {
  Eigen::MatrixXd result(family_.dimension(), members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = members_[i].coordinates;
  }
  return result;
}

Eigen::MatrixXd FamilyData::knownPoints() const {
  Eigen::MatrixXd result = points();
  for (const Eigen::VectorXd& point : failed_) {
    result.conservativeResize(family_.dimension(), result.cols() + 1);
    result.rightCols(1) = point;
  }
  return result;
}

void FamilyData::update() {
  std::vector<double> scales;
  std::vector<AxisCurve> curves;
  for (const FamilyMember& member : members_) {
    if (hasAxisCurves()) {
      curves.push_back(curveAt(member.coordinates));
    } else if (hasAxisForces()) {
      scales.push_back(scale(member.coordinates, {}));
    }
  }
  const LeaveOneOut left_out(family_, members_, scales, curves);
  covariance_ = chooseCovariance(points(), [&](const auto& weights) { return left_out.errors(weights); });
  measured_ = {};
  prepare();
  std::vector<double> all, relative;
  const Eigen::MatrixXd known = points();
  const std::vector<std::vector<double>> errors = left_out.errors(kriging_->leaveOneOut());
  for (std::size_t i = 0; i < errors.size() && errors.size() > 1; ++i) {
    Eigen::MatrixXd others(known.rows(), known.cols() - 1);
    const auto own = static_cast<Eigen::Index>(i);
    others << known.leftCols(own), known.rightCols(known.cols() - own - 1);
    const double deviation = Kriging(others, covariance_.lengths, covariance_.noise).deviation(known.col(own));
    for (const double error : errors[i]) {
      all.push_back(error);
      relative.push_back(error / std::max(deviation, std::numeric_limits<double>::min()));
    }
  }
  left_out_ = quantiles(all);
  per_deviation_ = quantiles(relative);
}

int FamilyData::refit() {
  int count = 0;
  for (FamilyMember& member : members_) {
    if (member.paths.empty()) continue;
    member = refitMember(family_, member);
    ++count;
  }
  if (count > 0) update();
  return count;
}

void FamilyData::prepare() {
  kriging_.emplace(points(), covariance_.lengths, covariance_.noise);
  std::vector<double> medians, commons;
  for (const FamilyMember& member : members_) {
    medians.push_back(member.median_error);
    commons.push_back(member.common_error);
  }
  fit_ = {quantile(medians, 0.5), quantile(commons, 0.5)};
}

bool FamilyData::serves(const Eigen::VectorXd& coordinates) const {
  if (members_.empty() || !Family::contains(coordinates)) return false;
  if (expectedError(coordinates).common > kLargestError) return false;
  const auto distance = [&](const Eigen::VectorXd& point) {
    return (point - coordinates).cwiseQuotient(covariance_.lengths).norm();
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const FamilyMember& member : members_) nearest = std::min(nearest, distance(member.coordinates));
  return std::all_of(failed_.begin(), failed_.end(), [&](const auto& point) { return distance(point) > nearest; });
}

void FamilyData::setMeasuredError(const ExpectedError& error, const std::vector<Eigen::VectorXd>& members) {
  measured_ = {static_cast<int>(members.size()), error, 0};
  for (const Eigen::VectorXd& member : members)
    measured_.deviation = std::max(measured_.deviation, kriging_->deviation(member));
}

ExpectedError FamilyData::expectedError(const Eigen::VectorXd& coordinates) const {
  const double deviation = kriging_->deviation(coordinates);
  if (measured_.members > 0) {
    const double factor = measured_.deviation > 0 ? std::max(1.0, deviation / measured_.deviation) : 1;
    return {factor * measured_.error.median, factor * measured_.error.common};
  }
  return {std::hypot(fit_.median, per_deviation_.median * deviation),
          std::hypot(fit_.common, per_deviation_.common * deviation)};
}

double FamilyData::scale(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& weights) const {
  if (hasAxisForces()) return std::exp(axisForceGrid(family_).interpolate(log_axis_forces_.col(0), coordinates));
  double sum = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    sum += weights[static_cast<Eigen::Index>(i)] * std::log(members_[i].scale);
  }
  return std::exp(sum);
}

AxisCurve FamilyData::curveAt(const Eigen::VectorXd& coordinates) const {
  const ChebyshevGrid grid = axisForceGrid(family_);
  Eigen::VectorXd log_forces(kAxisDepths);
  for (int i = 0; i < kAxisDepths; ++i) log_forces[i] = grid.interpolate(log_axis_forces_.col(i), coordinates);
  return axisCurve(log_forces);
}

AxisForce FamilyData::axisForce(const Eigen::VectorXd& coordinates) const {
  const SurrogatePlan plan = planMember(family_, family_.member(coordinates));
  return {curveAt(coordinates), plan.range.axis_depth, plan.scales.energy / plan.scales.length};
}

SurrogateData FamilyData::cell(const Eigen::VectorXd& coordinates) const {
  const Scene scene = family_.member(coordinates);
  const SurrogatePlan plan = planMember(family_, scene);
  const Eigen::VectorXd weights = kriging_->weights(coordinates);
  const FamilyMember& first = members_.front();
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(first.energy.size()),
                  field = Eigen::VectorXd::Zero(first.field.size());
  Eigen::MatrixXd amplitudes =
      Eigen::MatrixXd::Zero(surfaces_.amplitudes().front().rows(), surfaces_.amplitudes().front().cols());
  std::vector<const FamilyMember*> solved;
  const AxisCurve curve = hasAxisCurves() ? curveAt(coordinates) : AxisCurve();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const FamilyMember& member = members_[i];
    const double weight = weights[static_cast<Eigen::Index>(i)];
    EnergyExpansion own_energy(plan.scales, EnergyDegrees());
    ForceField own_field(plan.scales);
    own_energy.setCoefficients(member.energy);
    own_field.setCoefficients(member.field);
    if (curve) {
      const AxisCurve ratio = curveRatio(curve, member, own_field, plan.scales);
      own_energy.scaleAlongPaths(ratio, curve);
      own_field.scaleAlongPaths(ratio, curve);
    }
    energy += weight * own_energy.coefficients();
    field += weight * own_field.coefficients();
    amplitudes += weight * surfaces_.amplitudes()[i].cast<double>();
    solved.push_back(&member);
  }
  SurrogateData cell;
  cell.range = plan.range;
  const Reached reached = reachedAt(coordinates, solved);
  cell.range.depth *= reached.share;
  cell.range.lateral *= reached.share;
  cell.range.axis_depth *= reached.axis_share;
  cell.energy = EnergyExpansion(plan.scales, EnergyDegrees());
  const double scale = curve ? 1 : this->scale(coordinates, weights);
  cell.energy.setCoefficients(scale * energy);
  cell.field = ForceField(plan.scales);
  cell.field.setCoefficients(scale * field);
  cell.surface = SurfaceShape(plan.range, scene.radius(), surfaceCentres(), amplitudes, surfaces_.modes());
  const ExpectedError error = expectedError(coordinates);
  cell.median_error = error.median;
  cell.common_error = error.common;
  return cell;
}

void FamilyData::save(const std::string& path) const {
  ByteWriter writer;
  writer.array(provenance_);
  writer.array(covariance_.lengths);
  for (const double x :
       {covariance_.noise, left_out_.median, left_out_.common, per_deviation_.median, per_deviation_.common}) {
    writer.number(x);
  }
  writer.array(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(log_axis_forces_.data(), log_axis_forces_.size())));
  writer.number<std::uint64_t>(failed_.size());
  for (const Eigen::VectorXd& point : failed_) writer.array(point);
  writer.number<std::uint64_t>(members_.size());
  const Eigen::MatrixXf& modes = surfaces_.modes();
  writer.array(Eigen::VectorXf(Eigen::Map<const Eigen::VectorXf>(modes.data(), modes.size())));
  for (std::size_t i = 0; i < members_.size(); ++i) writeMember(writer, members_[i], surfaces_.amplitudes()[i]);
  for (const FamilyMember& member : members_) write(writer, member.paths);
  writer.number<std::int32_t>(measured_.members);
  for (const double x : {measured_.error.median, measured_.error.common, measured_.deviation}) writer.number(x);
  writeCacheFile(path, family_.description() + kVersion, writer.bytes());
}

FamilyData FamilyData::decode(const Family& family, const std::string& bytes) {
  ByteReader reader(bytes);
  FamilyData data(family);
  reader.array(data.provenance_);
  data.covariance_.lengths = readVector<Eigen::VectorXd>(reader, family.dimension());
  if (!(data.covariance_.lengths.minCoeff() > 0)) throw std::runtime_error("a length cannot be");
  for (double* x : {&data.covariance_.noise, &data.left_out_.median, &data.left_out_.common,
                    &data.per_deviation_.median, &data.per_deviation_.common}) {
    *x = reader.number<double>();
    if (!(std::isfinite(*x) && *x >= 0)) throw std::runtime_error("an error cannot be");
  }
  Eigen::VectorXd log_axis_forces;
  reader.array(log_axis_forces);
  const Eigen::Index nodes = axisForceGrid(family).size(), depths = log_axis_forces.size() / nodes;
  if (log_axis_forces.size() != depths * nodes || depths > kAxisDepths || (depths > 1 && depths < kAxisDepths) ||
      !log_axis_forces.allFinite()) {
    throw std::runtime_error("the forces on the axis cannot be");
  }
  data.log_axis_forces_ = Eigen::Map<const Eigen::MatrixXd>(log_axis_forces.data(), nodes, depths);
  for (std::uint64_t left = readCount(reader); left > 0; --left) {
    data.failed_.push_back(readVector<Eigen::VectorXd>(reader, family.dimension()));
  }
  const std::uint64_t count = readCount(reader);
  if (count == 0) throw std::runtime_error("it has no member");
  const Eigen::Index entries = 3 * static_cast<Eigen::Index>(SurfaceGrid::standard().nodeCount());
  const Eigen::Index places = surfaceCentres().cols();
  Eigen::VectorXf modes;
  reader.array(modes);
  if (modes.size() == 0 || modes.size() % entries != 0 || !modes.allFinite()) {
    throw std::runtime_error("the modes of the surface cannot be");
  }
  std::vector<Eigen::MatrixXf> surfaces;
  for (std::uint64_t i = 0; i < count; ++i) {
    data.members_.push_back(readMember(reader, family.dimension()));
    surfaces.push_back(readSurface(reader, places, modes.size() / entries));
  }
  for (FamilyMember& member : data.members_) member.paths = readPathForces(reader);
  if (!reader.atEnd()) data.measured_ = readMeasuredError(reader);  // older data end here
  if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
  data.surfaces_.set(Eigen::Map<const Eigen::MatrixXf>(modes.data(), entries, modes.size() / entries), surfaces);
  data.prepare();
  return data;
}

CacheRead<FamilyData> FamilyData::load(const Family& family, const std::string& path) {
  const CacheRead<std::string> read = readCacheFile(path, family.description() + kVersion);
  if (!read) return read.failure<FamilyData>();
  try {
    return {decode(family, *read.content), CacheState::kRead, ""};
  } catch (const std::exception& error) {
    return damagedCache<FamilyData>(path, error.what());
  }
}

}  // namespace microinjection
