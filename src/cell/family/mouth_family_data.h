#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/family/family_error.h"
#include "cell/family/mouth_family.h"

namespace microinjection {

/// A solved member of a MouthFamily: curves over the suction, or over the depth (rows), each a column. The first two
/// columns, or the only one, are logarithms of what an error is told of.
struct MouthMember {
  Eigen::VectorXd coordinates;
  Eigen::MatrixXd curves;
};

/// The solved members of a MouthFamily, from which any other one's curves are predicted: sums with the weights of
/// Kriging. One fidelity, unlike FamilyData, because a member costs seconds. predict() needs an update() or a load()
/// after the last add(); several threads may then use it at once.
class MouthFamilyData {
 public:
  struct Prediction {
    Eigen::MatrixXd curves;
    /// To be expected of the first columns: that of members that are left out, which one of ten has more than; larger,
    /// in proportion, where kriging is less certain. Not smaller where it is more certain, because it was too sure of
    /// members with a shell.
    Eigen::Vector2d error;
  };

  explicit MouthFamilyData(MouthFamily family)
      : family_(std::move(family)), covariance_{Eigen::VectorXd::Constant(family_.dimension(), 2), 0} {}

  const MouthFamily& family() const { return family_; }
  const std::vector<MouthMember>& members() const { return members_; }
  const std::vector<Eigen::VectorXd>& failed() const { return failed_; }  ///< coordinates without a solution
  /// Where the data come from: text for the reader of the file, kept as it was stored.
  const std::string& provenance() const { return provenance_; }
  void setProvenance(std::string text) { provenance_ = std::move(text); }

  void add(MouthMember member) { members_.push_back(std::move(member)); }
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
  static CacheRead<MouthFamilyData> load(const MouthFamily& family, const std::string& path);
  /// Family file and data beside it. @throws ConfigError where one of them cannot be used
  static MouthFamilyData loadBoth(const std::string& family_file);

 private:
  Eigen::MatrixXd points() const;
  bool isNearFailed(const Eigen::VectorXd& coordinates) const;
  void prepare();
  static MouthFamilyData decode(const MouthFamily& family, const std::string& bytes);

  MouthFamily family_;
  std::string provenance_;
  std::vector<MouthMember> members_;
  std::vector<Eigen::VectorXd> failed_;
  Covariance covariance_;
  ExpectedError left_out_[2], per_deviation_[2];  ///< the latter: the same over Kriging::deviation
  std::optional<Kriging> kriging_;
};

}  // namespace microinjection
