#include "cell/family/section_family_data.h"

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

constexpr char kSectionVersion[] = " data 1";  ///< change it when the format or the solution changes
constexpr std::uint64_t kMostCurves = 1000;    ///< members, or columns of one

/// Relative errors of each member's values in a column, predicted with these weights.
std::vector<std::vector<double>> columnErrors(const std::vector<SectionMember>& members, int column,
                                              const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd known(members.size(), members.front().curves.rows());
  for (std::size_t i = 0; i < members.size(); ++i)
    known.row(static_cast<Eigen::Index>(i)) = members[i].curves.col(column).transpose();
  const Eigen::MatrixXd difference = weights * known - known;
  std::vector<std::vector<double>> errors(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (const double x : difference.row(static_cast<Eigen::Index>(i))) errors[i].push_back(std::abs(std::expm1(x)));
  }
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

/// Median, and what one of ten exceeds, of all errors over their member's deviation.
ExpectedError quantilesOf(const std::vector<std::vector<double>>& errors, const Eigen::VectorXd& deviations) {
  std::vector<double> all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    for (const double error : errors[i])
      all.push_back(error / std::max(deviations[static_cast<Eigen::Index>(i)], 1e-300));
  }
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  return {at(0.5), at(0.9)};
}

void write(ByteWriter& writer, const Eigen::MatrixXd& values) {
  const Eigen::MatrixXf single = values.cast<float>();
  writer.array(Eigen::VectorXf(Eigen::Map<const Eigen::VectorXf>(single.data(), single.size())));
}

Eigen::MatrixXd readMatrix(ByteReader& reader, Eigen::Index rows, Eigen::Index columns) {
  Eigen::VectorXf values;
  reader.array(values);
  if (values.size() != rows * columns) throw std::runtime_error("a size cannot be");
  if (!values.allFinite()) throw std::runtime_error("a value is not finite");
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), rows, columns).cast<double>();
}

double readNotNegative(ByteReader& reader) {
  const auto value = reader.number<double>();
  if (!(std::isfinite(value) && value >= 0)) throw std::runtime_error("a number cannot be");
  return value;
}

Eigen::Index readSmallCount(ByteReader& reader) {
  const auto value = reader.number<std::uint64_t>();
  if (value > kMostCurves) throw std::runtime_error("a number of members or curves cannot be");
  return static_cast<Eigen::Index>(value);
}

}  // namespace

Eigen::MatrixXd SectionFamilyData::points() const {
  Eigen::MatrixXd result(family_.dimension(), members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) result.col(static_cast<Eigen::Index>(i)) = members_[i].coordinates;
  return result;
}

Eigen::MatrixXd SectionFamilyData::knownPoints() const {
  Eigen::MatrixXd result(family_.dimension(), members_.size() + failed_.size());
  result.leftCols(static_cast<Eigen::Index>(members_.size())) = points();
  for (std::size_t i = 0; i < failed_.size(); ++i)
    result.col(static_cast<Eigen::Index>(members_.size() + i)) = failed_[i];
  return result;
}

void SectionFamilyData::prepare() {
  if (!members_.empty()) kriging_.emplace(points(), covariance_.lengths, covariance_.noise);
}

void SectionFamilyData::update() {
  if (members_.size() < 2) return;
  // What is pierced depends on the toughness, the whole cell does not; adhesion is most of a shallow way out.
  const SectionFamily::Kind kind = family_.kind();
  const int hardest = kind == SectionFamily::Kind::kPierced || kind == SectionFamily::Kind::kWithdrawal ? 1 : 0;
  covariance_ =
      chooseCovariance(points(), [&](const auto& weights) { return columnErrors(members_, hardest, weights); });
  prepare();
  const Eigen::MatrixXd weights = kriging_->leaveOneOut();
  const Eigen::VectorXd deviations = leftOutDeviations(points(), covariance_);
  for (int column = 0; column < std::min<int>(2, static_cast<int>(members_.front().curves.cols())); ++column) {
    const auto errors = columnErrors(members_, column, weights);
    left_out_[column] = quantilesOf(errors, Eigen::VectorXd::Ones(deviations.size()));
    per_deviation_[column] = quantilesOf(errors, deviations);
  }
}

Eigen::VectorXd SectionFamilyData::coordinatesOf(const Scene& scene) const {
  std::string misfit;
  auto coordinates = family_.coordinatesOf(scene, &misfit);
  if (!coordinates) throw ConfigError("family " + family_.name() + ": " + misfit);
  return std::move(*coordinates);
}

bool SectionFamilyData::isNearFailed(const Eigen::VectorXd& coordinates) const {
  const auto distance = [&](const Eigen::VectorXd& point) { return (point - coordinates).norm(); };
  double nearest = std::numeric_limits<double>::infinity();
  for (const SectionMember& member : members_) nearest = std::min(nearest, distance(member.coordinates));
  return std::any_of(failed_.begin(), failed_.end(), [&](const auto& point) { return distance(point) < nearest; });
}

SectionFamilyData::Prediction SectionFamilyData::predict(const Eigen::VectorXd& coordinates) const {
  if (const std::string refusal = family_.refusal(coordinates); !refusal.empty())
    throw ConfigError("family " + family_.name() + ": " + refusal);
  if (!isComplete())
    throw ConfigError("family " + family_.name() + " has only " + std::to_string(members_.size()) + " members");
  if (isNearFailed(coordinates))
    throw ConfigError("family " + family_.name() + ": the member nearest to this cell has no solution");
  const Eigen::VectorXd weights = kriging_->weights(coordinates);
  const SectionMember& first = members_.front();
  Prediction result{Eigen::MatrixXd::Zero(first.curves.rows(), first.curves.cols()), Eigen::Vector2d::Zero()};
  for (std::size_t i = 0; i < members_.size(); ++i)
    result.curves += weights[static_cast<Eigen::Index>(i)] * members_[i].curves;
  const double deviation = kriging_->deviation(coordinates);
  for (const int column : {0, 1})
    result.error[column] = std::max(deviation * per_deviation_[column].common, left_out_[column].common);
  return result;
}

void SectionFamilyData::save(const std::string& path) const {
  ByteWriter writer;
  writer.array(provenance_);
  writer.array(covariance_.lengths);
  writer.number(covariance_.noise);
  for (const ExpectedError& error : {left_out_[0], left_out_[1], per_deviation_[0], per_deviation_[1]}) {
    writer.number(error.median);
    writer.number(error.common);
  }
  writer.number<std::uint64_t>(failed_.size());
  for (const Eigen::VectorXd& point : failed_) write(writer, point);
  writer.number<std::uint64_t>(members_.size());
  writer.number<std::uint64_t>(members_.empty() ? 0 : members_.front().curves.rows());
  writer.number<std::uint64_t>(members_.empty() ? 0 : members_.front().curves.cols());
  for (const SectionMember& member : members_) {
    write(writer, member.coordinates);
    write(writer, member.curves);
  }
  writeCacheFile(path, family_.description() + kSectionVersion, writer.bytes());
}

SectionFamilyData SectionFamilyData::decode(const SectionFamily& family, const std::string& bytes) {
  ByteReader reader(bytes);
  SectionFamilyData data(family);
  reader.array(data.provenance_);
  reader.array(data.covariance_.lengths);
  if (data.covariance_.lengths.size() != family.dimension() || !(data.covariance_.lengths.minCoeff() > 0))
    throw std::runtime_error("a length cannot be");
  data.covariance_.noise = readNotNegative(reader);
  for (ExpectedError* error :
       {&data.left_out_[0], &data.left_out_[1], &data.per_deviation_[0], &data.per_deviation_[1]}) {
    error->median = readNotNegative(reader);
    error->common = readNotNegative(reader);
  }
  for (Eigen::Index left = readSmallCount(reader); left > 0; --left)
    data.failed_.emplace_back(readMatrix(reader, family.dimension(), 1));
  const Eigen::Index members = readSmallCount(reader), rows = readSmallCount(reader), columns = readSmallCount(reader);
  if (members > 0 && (rows == 0 || columns == 0)) throw std::runtime_error("a size cannot be");
  for (Eigen::Index i = 0; i < members; ++i) {
    Eigen::VectorXd coordinates = readMatrix(reader, family.dimension(), 1);
    data.members_.push_back({std::move(coordinates), readMatrix(reader, rows, columns)});
  }
  if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
  data.prepare();
  return data;
}

CacheRead<SectionFamilyData> SectionFamilyData::load(const SectionFamily& family, const std::string& path) {
  const CacheRead<std::string> read = readCacheFile(path, family.description() + kSectionVersion);
  if (!read) return read.failure<SectionFamilyData>();
  try {
    return {decode(family, *read.content), CacheState::kRead, ""};
  } catch (const std::exception& error) {
    return damagedCache<SectionFamilyData>(path, error.what());
  }
}

SectionFamilyData SectionFamilyData::loadBoth(const std::string& family_file) {
  CacheRead<SectionFamilyData> read = load(SectionFamily::load(family_file), familyDataFile(family_file));
  if (!read) throw ConfigError(read.reason + "; to make it: prepare --family " + family_file);
  return std::move(*read.content);
}

}  // namespace microinjection
