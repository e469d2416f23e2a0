#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/family/family.h"
#include "cell/family/family_error.h"
#include "cell/family/family_member.h"
#include "cell/family/surface_modes.h"

namespace microinjection {

/// Errors that were measured at converged places of members that the family has not.
struct MeasuredError {
  int members = 0;  ///< drawn at random; 0: nothing was measured
  ExpectedError error;
  double deviation = 0;  ///< kriging's largest estimate among these members
};

/// The force on the axis of a member, without dimension: unit curve(sqrt(depth / length)).
struct AxisForce {
  AxisCurve curve;
  double length = 0;  ///< the depth of the range on the axis
  double unit = 0;
};

/// The solved members of a family, from which it makes any other one.
///
///     coordinates --> Kriging: a weight for each member --> sum of their coefficients --> SurrogateData
///        |                                                       ^
///        `--> ChebyshevGrid: the force on the axis at 12 depths --> each member's forces are scaled
///             to it first, along every straight path
///
/// Two fidelities, because the section on the axis costs a hundredth of a member and has the largest part of what
/// varies. It is solved on a grid of 6 points for each ratio; what is left to interpolate between the members is how
/// the force beside the axis differs from that on it. Each of 22 members of `homogeneous`, predicted from the other 21
/// (doc/design/families.md, Why two fidelities; median, nine of ten below):
///
///     prediction                 members only     scaled to the force on the axis
///     polynomial of degree 2     1.2, 2.6 %       0.9, 2.5 %
///     polynomial of degree 3     0.8, 2.7 %       0.9, 2.9 %
///     kriging                    0.5, 1.5 %       0.3, 1.1 %
///
/// Kriging also estimates its own error from the places of the members, which chooses the next member to solve
/// (next_members.h) and tells a cell with too few members around it. Members that were not trained are met to 0.60 % of
/// the force (`homogeneous`) and 0.50 % (`zona`; medians, doc/reference/benchmarks.md, Families of cells).
///
/// Everything is without dimension. The predictions, from serves() to axisForce(), need an update() or a load() after
/// the last add(); several threads may then use them at once.
class FamilyData {
 public:
  explicit FamilyData(Family family) : family_(std::move(family)) {}

  const Family& family() const { return family_; }
  const std::vector<FamilyMember>& members() const { return members_; }
  /// Coordinates of members without a solution.
  const std::vector<Eigen::VectorXd>& failed() const { return failed_; }
  /// Where the data come from: text for the reader of the file, kept as it was stored.
  const std::string& provenance() const { return provenance_; }
  void setProvenance(std::string text) { provenance_ = std::move(text); }

  /// `displacements`: of SurfaceGrid (rows) at surfacePlaces() (columns), over the cell's radius.
  void add(const FamilyMember& member, const Eigen::MatrixXf& displacements);
  void addFailed(const Eigen::VectorXd& coordinates) { failed_.push_back(coordinates); }
  /// Forces on the axis at the nodes of axisForceGrid() (rows): a column for each depth of an
  /// AxisCurve, or one at half of the range's depth (older data). Without them, a cell's is predicted
  /// from the members.
  void setAxisForces(const Eigen::MatrixXd& forces) { log_axis_forces_ = forces.array().log(); }
  bool hasAxisForces() const { return log_axis_forces_.size() > 0; }
  bool hasAxisCurves() const { return log_axis_forces_.cols() == kAxisDepths; }
  /// Fits all members anew whose paths are known, and returns their number. A second for each. Without
  /// any, measured errors stay.
  int refit();
  /// Chooses the covariance and estimates the errors anew. Call it after the last add(). Measured
  /// errors are forgotten.
  void update();
  /// Takes the errors that were measured at these members' coordinates.
  void setMeasuredError(const ExpectedError& error, const std::vector<Eigen::VectorXd>& members);
  const MeasuredError& measuredError() const { return measured_; }

  /// A column for each member and each failed one.
  Eigen::MatrixXd knownPoints() const;
  const Covariance& covariance() const { return covariance_; }
  /// Errors of the members when each is predicted from the others.
  ExpectedError leaveOneOutError() const { return left_out_; }

  /// Whether there are members enough to know the error of a prediction.
  bool isComplete() const { return static_cast<int>(members_.size()) > 2 * family_.dimension(); }
  /// Whether there is a converged solution around these coordinates, because the nearest member did
  /// not fail, and members enough around them: nine of ten places are expected within a tenth.
  bool serves(const Eigen::VectorXd& coordinates) const;
  /// The measured errors; larger, in proportion, where kriging is less certain than at any member
  /// that was compared. Without a measurement: that of the members' own fits and kriging's estimate,
  /// scaled by leaving members out.
  ExpectedError expectedError(const Eigen::VectorXd& coordinates) const;
  /// The member at any coordinates, without dimension. Its range is the part that its neighbours
  /// reached, its errors are those of expectedError(). Takes milliseconds.
  SurrogateData cell(const Eigen::VectorXd& coordinates) const;
  /// What cell() has on the axis, in a hundredth of its time. @pre hasAxisCurves()
  AxisForce axisForce(const Eigen::VectorXd& coordinates) const;

  /// Throws WriteError.
  void save(const std::string& path) const;
  /// The state is kOther for data of another family or version, and kDamaged for an invalid size or
  /// value.
  static CacheRead<FamilyData> load(const Family& family, const std::string& path);

 private:
  Eigen::MatrixXd points() const;  ///< of the members, a column each
  double scale(const Eigen::VectorXd& coordinates, const Eigen::VectorXd& weights) const;
  AxisCurve curveAt(const Eigen::VectorXd& coordinates) const;
  void prepare();  ///< what follows from the members and the covariance
  static FamilyData decode(const Family& family, const std::string& bytes);

  Family family_;
  std::string provenance_;
  std::vector<FamilyMember> members_;
  std::vector<Eigen::VectorXd> failed_;
  Eigen::MatrixXd log_axis_forces_;
  SurfaceModes surfaces_;
  MeasuredError measured_;
  Covariance covariance_;
  ExpectedError left_out_, fit_;  ///< of the prediction, and of the members' own fits
  ExpectedError per_deviation_;   ///< of the prediction, over Kriging::deviation
  std::optional<Kriging> kriging_;
};

}  // namespace microinjection
