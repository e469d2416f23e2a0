#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/family/family_error.h"
#include "cell/family/family_tongue.h"
#include "cell/family/tongue_family.h"
#include "cell/family/tongue_member.h"

namespace microinjection {

/// The solved members of a tongue family, from which it makes the tongue of any other one: the curves of a member are
/// sums of those of the solved ones, with the weights of Kriging.
///
///     ratios --> coordinates --> a weight for each member --> TongueCurves --> FamilyTongue, at(suction / E)
///
/// One fidelity, unlike FamilyData: a member costs ten seconds. tongue() needs an update() or a load() after the last
/// add(); several threads may then use it at once.
class TongueFamilyData {
 public:
  explicit TongueFamilyData(TongueFamily family)
      : family_(std::move(family)), covariance_{Eigen::VectorXd::Constant(family_.dimension(), 2), 0} {}

  const TongueFamily& family() const { return family_; }
  const std::vector<TongueMember>& members() const { return members_; }
  const std::vector<Eigen::VectorXd>& failed() const { return failed_; }  ///< coordinates without a solution
  /// Where the data come from: text for the reader of the file, kept as it was stored.
  const std::string& provenance() const { return provenance_; }
  void setProvenance(std::string text) { provenance_ = std::move(text); }

  void add(TongueMember member) { members_.push_back(std::move(member)); }
  void addFailed(const Eigen::VectorXd& coordinates) { failed_.push_back(coordinates); }
  /// Chooses the covariance and estimates the errors anew.
  void update();

  Eigen::MatrixXd knownPoints() const;  ///< a column for each member and each failed one
  const Covariance& covariance() const { return covariance_; }
  /// Relative errors of the tongues' rise above the touch when each member is predicted from the others; of the end,
  /// endError().
  const ExpectedError& leaveOneOutError() const { return left_out_; }
  const ExpectedError& endError() const { return end_left_out_; }

  /// Whether there are members enough to know the error of a prediction.
  bool isComplete() const { return static_cast<int>(members_.size()) > 2 * family_.dimension(); }
  /// Takes some ten microseconds. @throws ConfigError for a family that is not complete, or that names each ratio that
  /// is outside of the family, its value and what is allowed
  FamilyTongue tongue(const Eigen::VectorXd& coordinates) const;
  /// Of a scene in SI units. @throws ConfigError also for a scene of another form
  FamilyTongue tongue(const Scene& scene) const;

  /// Throws WriteError.
  void save(const std::string& path) const;
  /// The state is kOther for data of another family or version, and kDamaged for an invalid size or value.
  static CacheRead<TongueFamilyData> load(const TongueFamily& family, const std::string& path);
  /// Family file and data beside it. @throws ConfigError where one of them cannot be used
  static TongueFamilyData loadBoth(const std::string& family_file);

 private:
  Eigen::MatrixXd points() const;
  TongueCurves predict(const Eigen::VectorXd& weights) const;
  void prepare();
  static TongueFamilyData decode(const TongueFamily& family, const std::string& bytes);

  TongueFamily family_;
  std::string provenance_;
  std::vector<TongueMember> members_;
  std::vector<Eigen::VectorXd> failed_;
  Covariance covariance_;
  ExpectedError left_out_, end_left_out_;
  ExpectedError per_deviation_, end_per_deviation_;  ///< the same over Kriging::deviation
  std::optional<Kriging> kriging_;
};

/// The tongue of a scene's cell by the first family of a folder (*.yaml with data beside them) that has it; nothing
/// when none has: `reason` is one line for the user.
std::optional<FamilyTongue> findFamilyTongue(const std::string& folder, const Scene& scene, std::string& reason);

}  // namespace microinjection
