#include "cell/family/tongue_family_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "base/bytes.h"
#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/family/kriging.h"

namespace microinjection {
namespace {

constexpr char kTongueVersion[] = " tongue data 1";  ///< change it when the format or the solution changes
constexpr std::uint64_t kMostTongues = 1000;
constexpr Eigen::Index kSurfaceRows = 2 * TongueCurves::kPlaces;

/// Errors of each member's rise, predicted with these weights, at all its suctions.
std::vector<std::vector<double>> riseErrors(const std::vector<TongueMember>& members, const Eigen::MatrixXd& weights) {
  std::vector<std::vector<double>> errors(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    Eigen::VectorXd difference = -members[i].curves.values.col(0);
    for (std::size_t j = 0; j < members.size(); ++j) {
      difference +=
          weights(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * members[j].curves.values.col(0);
    }
    for (const double x : difference) errors[i].push_back(std::abs(std::expm1(x)));
  }
  return errors;
}

std::vector<std::vector<double>> endErrors(const std::vector<TongueMember>& members, const Eigen::MatrixXd& weights) {
  Eigen::VectorXd ends(static_cast<Eigen::Index>(members.size()));
  for (std::size_t i = 0; i < members.size(); ++i) ends[static_cast<Eigen::Index>(i)] = members[i].curves.log_end;
  const Eigen::VectorXd difference = weights * ends - ends;
  std::vector<std::vector<double>> errors;
  for (const double x : difference) errors.push_back({std::abs(std::expm1(x))});
  return errors;
}

/// Kriging::deviation at each member from all others.
Eigen::VectorXd leftOutDeviations(const Eigen::MatrixXd& points, const Covariance& covariance) {
  Eigen::VectorXd result(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::MatrixXd others(points.rows(), points.cols() - 1);
    others << points.leftCols(i), points.rightCols(points.cols() - i - 1);
    result[i] = Kriging(others, covariance.lengths, covariance.noise).deviation(points.col(i));
  }
  return result;
}

/// Median, and what one of ten exceeds, of all errors; over their member's deviation where there is one.
ExpectedError quantilesOf(const std::vector<std::vector<double>>& errors, const Eigen::VectorXd& deviations = {}) {
  std::vector<double> all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double over = deviations.size() == 0 ? 1 : std::max(deviations[static_cast<Eigen::Index>(i)], 1e-300);
    for (const double error : errors[i]) all.push_back(error / over);
  }
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  return all.empty() ? ExpectedError() : ExpectedError{at(0.5), at(0.9)};
}

void write(ByteWriter& writer, const Eigen::MatrixXd& values) {
  const Eigen::MatrixXf rounded_values = values.cast<float>();
  writer.array(Eigen::VectorXf(Eigen::Map<const Eigen::VectorXf>(rounded_values.data(), rounded_values.size())));
}

Eigen::MatrixXd readMatrix(ByteReader& reader, Eigen::Index rows, Eigen::Index columns) {
  Eigen::VectorXf values;
  reader.array(values);
  if (values.size() != rows * columns) throw std::runtime_error("a size cannot be");
  if (!values.allFinite()) throw std::runtime_error("a value is not finite");
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), rows, columns).cast<double>();
}

double readNumber(ByteReader& reader, double lowest) {
  const auto value = reader.number<double>();
  if (!(std::isfinite(value) && value >= lowest)) throw std::runtime_error("a number cannot be");
  return value;
}

TongueMember readTongue(ByteReader& reader, Eigen::Index dimension) {
  TongueMember member;
  member.coordinates = readMatrix(reader, dimension, 1);
  member.curves.log_end = readNumber(reader, -100);
  member.curves.ends = reader.number<std::uint8_t>() != 0;
  member.curves.values = readMatrix(reader, TongueCurves::kNodes, 3);
  member.curves.surface = readMatrix(reader, TongueCurves::kNodes, kSurfaceRows);
  return member;
}

}  // namespace

Eigen::MatrixXd TongueFamilyData::points() const {
  Eigen::MatrixXd result(family_.dimension(), members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = members_[i].coordinates;
  return result;
}

Eigen::MatrixXd TongueFamilyData::knownPoints() const {
  Eigen::MatrixXd result(family_.dimension(), members_.size() + failed_.size());
  result.leftCols(static_cast<Eigen::Index>(members_.size())) = points();
  for (std::size_t i = 0; i < failed_.size(); ++i)
    result.col(static_cast<Eigen::Index>(members_.size() + i)) = failed_[i];
  return result;
}

void TongueFamilyData::prepare() {
  if (!members_.empty()) kriging_.emplace(points(), covariance_.lengths, covariance_.noise);
}

void TongueFamilyData::update() {
  if (members_.empty()) return;
  covariance_ = chooseCovariance(points(), [&](const auto& weights) { return riseErrors(members_, weights); });
  prepare();
  const Eigen::MatrixXd weights = kriging_->leaveOneOut();
  const Eigen::VectorXd deviations = leftOutDeviations(points(), covariance_);
  left_out_ = quantilesOf(riseErrors(members_, weights));
  per_deviation_ = quantilesOf(riseErrors(members_, weights), deviations);
  end_left_out_ = quantilesOf(endErrors(members_, weights));
  end_per_deviation_ = quantilesOf(endErrors(members_, weights), deviations);
}

TongueCurves TongueFamilyData::predict(const Eigen::VectorXd& weights) const {
  TongueCurves sum;
  sum.values = Eigen::MatrixXd::Zero(TongueCurves::kNodes, 3);
  sum.surface = Eigen::MatrixXd::Zero(TongueCurves::kNodes, kSurfaceRows);
  double ending = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    const TongueCurves& curves = members_[i].curves;
    sum.log_end += weight * curves.log_end;
    sum.values += weight * curves.values;
    sum.surface += weight * curves.surface;
    ending += weight * (curves.ends ? 1 : 0);
  }
  sum.ends = ending > 0.5;
  return sum;
}

FamilyTongue TongueFamilyData::tongue(const Eigen::VectorXd& coordinates) const {
  if (const std::string refusal = family_.refusal(coordinates); !refusal.empty())
    throw ConfigError("tongue family " + family_.name() + ": " + refusal);
  if (!isComplete())
    throw ConfigError("tongue family " + family_.name() + " has only " + std::to_string(members_.size()) + " members");
  const double deviation = kriging_->deviation(coordinates);
  return {touchOf(family_.member(coordinates)), predict(kriging_->weights(coordinates)),
          per_deviation_.common * deviation, end_per_deviation_.common * deviation};
}

FamilyTongue TongueFamilyData::tongue(const Scene& scene) const {
  std::string misfit;
  const auto coordinates = family_.coordinatesOf(scene, &misfit);
  if (!coordinates) throw ConfigError("tongue family " + family_.name() + ": " + misfit);
  return tongue(*coordinates);
}

void TongueFamilyData::save(const std::string& path) const {
  ByteWriter writer;
  writer.array(provenance_);
  writer.array(covariance_.lengths);
  writer.number(covariance_.noise);
  for (const ExpectedError& error : {left_out_, per_deviation_, end_left_out_, end_per_deviation_}) {
    writer.number(error.median);
    writer.number(error.common);
  }
  writer.number<std::uint64_t>(failed_.size());
  for (const Eigen::VectorXd& point : failed_) write(writer, point);
  writer.number<std::uint64_t>(members_.size());
  for (const TongueMember& member : members_) {
    write(writer, member.coordinates);
    writer.number(member.curves.log_end);
    writer.number<std::uint8_t>(member.curves.ends ? 1 : 0);
    write(writer, member.curves.values);
    write(writer, member.curves.surface);
  }
  writeCacheFile(path, family_.description() + kTongueVersion, writer.bytes());
}

TongueFamilyData TongueFamilyData::decode(const TongueFamily& family, const std::string& bytes) {
  ByteReader reader(bytes);
  TongueFamilyData data(family);
  reader.array(data.provenance_);
  reader.array(data.covariance_.lengths);
  if (data.covariance_.lengths.size() != family.dimension() || !(data.covariance_.lengths.minCoeff() > 0))
    throw std::runtime_error("a length cannot be");
  data.covariance_.noise = readNumber(reader, 0);
  for (ExpectedError* error : {&data.left_out_, &data.per_deviation_, &data.end_left_out_, &data.end_per_deviation_}) {
    error->median = readNumber(reader, 0);
    error->common = readNumber(reader, 0);
  }
  const auto count = [&] {
    const auto value = reader.number<std::uint64_t>();
    if (value > kMostTongues) throw std::runtime_error("a number of members cannot be");
    return value;
  };
  for (std::uint64_t left = count(); left > 0; --left)
    data.failed_.emplace_back(readMatrix(reader, family.dimension(), 1));
  for (std::uint64_t left = count(); left > 0; --left) data.members_.push_back(readTongue(reader, family.dimension()));
  if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
  data.prepare();
  return data;
}

CacheRead<TongueFamilyData> TongueFamilyData::load(const TongueFamily& family, const std::string& path) {
  const CacheRead<std::string> read = readCacheFile(path, family.description() + kTongueVersion);
  if (!read) return read.failure<TongueFamilyData>();
  try {
    return {decode(family, *read.content), CacheState::kRead, ""};
  } catch (const std::exception& error) {
    return damagedCache<TongueFamilyData>(path, error.what());
  }
}

TongueFamilyData TongueFamilyData::loadBoth(const std::string& family_file) {
  CacheRead<TongueFamilyData> read = load(TongueFamily::load(family_file), familyDataFile(family_file));
  if (!read) throw ConfigError(read.reason + "; make it: prepare --family " + family_file);
  return std::move(*read.content);
}

std::optional<FamilyTongue> findFamilyTongue(const std::string& folder, const Scene& scene, std::string& reason) {
  reason.clear();
  for (const std::string& file : familyFiles(folder)) {
    try {
      return TongueFamilyData::loadBoth(file).tongue(scene);
    } catch (const ConfigError& error) {
      reason += (reason.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  if (reason.empty()) reason = folder + " has no family";
  return std::nullopt;
}

}  // namespace microinjection
