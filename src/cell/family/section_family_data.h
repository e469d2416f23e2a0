#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/family/family_error.h"
#include "cell/family/section_family.h"

namespace microinjection {

/// A solved member of a SectionFamily: curves over the suction, or over the depth (rows), each a column. The first two
/// columns, or the only one, are logarithms of what an error is told of.
struct SectionMember {
  Eigen::VectorXd coordinates;
  Eigen::MatrixXd curves;
};

/// The solved members of a SectionFamily, from which any other one's curves are predicted: sums with the weights of
/// Kriging. One fidelity, unlike FamilyData, because a member costs seconds, a pierced one half a minute. predict()
/// needs an update() or a load() after the last add(); several threads may then use it at once.
class SectionFamilyData {
 public:
  struct Prediction {
    Eigen::MatrixXd curves;
    /// To be expected of the first columns: that of members that are left out, which one of ten has more than; larger,
    /// in proportion, where kriging is less certain. Not smaller where it is more certain, because it was too sure of
    /// members with a shell.
    Eigen::Vector2d error;
  };

  explicit SectionFamilyData(SectionFamily family)
      : family_(std::move(family)), covariance_{Eigen::VectorXd::Constant(family_.dimension(), 2), 0} {}

  const SectionFamily& family() const { return family_; }
  const std::vector<SectionMember>& members() const { return members_; }
  const std::vector<Eigen::VectorXd>& failed() const { return failed_; }  ///< coordinates without a solution
  /// Where the data come from: text for the reader of the file, kept as it was stored.
  const std::string& provenance() const { return provenance_; }
  void setProvenance(std::string text) { provenance_ = std::move(text); }

  void add(SectionMember member) { members_.push_back(std::move(member)); }
  void addFailed(const Eigen::VectorXd& coordinates) { failed_.push_back(coordinates); }
  /// Chooses the covariance and estimates the errors anew.
  void update();

  Eigen::MatrixXd knownPoints() const;  ///< a column for each member and each failed one
  const Covariance& covariance() const { return covariance_; }
  /// Errors of one of the first two columns when each member is predicted from the others.
  const ExpectedError& leaveOneOutError(int column) const { return left_out_[column]; }

  /// Whether there are members enough to know the error of a prediction.
  bool isComplete() const { return static_cast<int>(members_.size()) > 2 * family_.dimension(); }
  /// Coordinates of a scene in SI units. @throws ConfigError for a scene of another form
  Eigen::VectorXd coordinatesOf(const Scene& scene) const;
  /// Takes some ten microseconds. @throws ConfigError for a family that is not complete, or that names each ratio that
  /// is outside of the family, its value and what is allowed
  Prediction predict(const Eigen::VectorXd& coordinates) const;

  /// Throws WriteError.
  void save(const std::string& path) const;
  /// The state is kOther for data of another family or version, and kDamaged for an invalid size or value.
  static CacheRead<SectionFamilyData> load(const SectionFamily& family, const std::string& path);
  /// Family file and data beside it. @throws ConfigError where one of them cannot be used
  static SectionFamilyData loadBoth(const std::string& family_file);

 private:
  Eigen::MatrixXd points() const;
  bool isNearFailed(const Eigen::VectorXd& coordinates) const;
  void prepare();
  static SectionFamilyData decode(const SectionFamily& family, const std::string& bytes);

  SectionFamily family_;
  std::string provenance_;
  std::vector<SectionMember> members_;
  std::vector<Eigen::VectorXd> failed_;
  Covariance covariance_;
  ExpectedError left_out_[2], per_deviation_[2];  ///< the latter: the same over Kriging::deviation
  std::optional<Kriging> kriging_;
};

}  // namespace microinjection
