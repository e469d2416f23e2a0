#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/bytes.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_data.h"
#include "cell/family/family_places.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

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
