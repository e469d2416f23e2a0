#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cell/mechanics/reference_element.h"
#include "cell/model/scene.h"

namespace microinjection {

template <int Dim>
class CellProblem;

/// Series of depths of a needle.
struct Indenting {
  std::vector<double> depths;                         ///< m, each >= 0, in any order
  Eigen::Vector2d lateral = Eigen::Vector2d::Zero();  ///< m, of the tip at every depth, reached along a straight line
  std::optional<double> speed;                        ///< m/s, of the tip; none: viscous stresses relax
  double hold = 0;                                    ///< s at each depth before its force is computed
  /// Decreasing depths, m, below the deepest of `depths`, for a straight withdrawal at the same
  /// speed. Below 0 the tip is above the contact point, and adhesion pulls it.
  std::vector<double> withdrawal;

  std::size_t count() const { return depths.size() + withdrawal.size(); }
  /// Depth of the i-th force: depths, then withdrawal.
  double depth(std::size_t i) const { return i < depths.size() ? depths[i] : withdrawal[i - depths.size()]; }
  /// Throws ConfigError when the withdrawal does not decrease.
  void validate() const;
};

struct ConvergedForceConfig {
  enum class Model {
    kAuto,          ///< axisymmetric if the scene allows it
    kAxisymmetric,  ///< the section
    kSpatial        ///< in space, see sweepSection
  };
  Model model = Model::kAuto;
  ElementKind element = ElementKind::kP2P0;
  double tolerance = 0.005;  ///< relative error of the force below which a depth is not refined further
  double finest = 6;         ///< last level of refinement that may be tried, see scene_mesh.h
  /// s of wall time after which no third or finer level is started. Infinite: a mesh that does not fit into the memory
  /// is an error, for the forces must not depend on the machine. Else the forces of the coarser ones are kept.
  double time = 600;
};

/// Force at one depth.
struct ForcePoint {
  double depth = 0;  ///< m
  bool converged = false;
  std::string reason;  ///< why it did not converge, or why no finer mesh has a solution; else empty
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the needle
  /// Relative, from the last two levels, of a disc in the section from the last three. On withdrawal, where the force
  /// changes its sign, it is relative to the largest force of the path.
  double error_estimate = std::numeric_limits<double>::quiet_NaN();
  double level = -1;     ///< of the mesh that gave the force
  double wall_time = 0;  ///< s, of all levels
};

/// Statistics of one mesh.
struct LevelReport {
  double level = 0;  ///< see scene_mesh.h
  std::size_t nodes = 0, elements = 0;
  int unknowns = 0;
  double wall_time = 0;        ///< s
  std::vector<double> forces;  ///< N, magnitude at each depth (order of Indenting::depth), nan without solution
};

/// Solves a scene on successively finer meshes until two of them agree to the tolerance at every depth: the force that
/// `indent` prints, and the reference for the error of a live cell (measureLiveCell). One mesh, however fine, would
/// give a force of unknown error, and the error differs between scenes, because the sharp edge of a disc or the border
/// of a moving contact governs it.
///
///     level          l        l + step     l + 2 step            elements at the needle: size at 0 over 2^level
///     force          F_0  -->  F_1  ----->  F_2                  step 1 (factor 2) in the section, which is cheap,
///     estimate              |F_1 - F_0|   |F_2 - F_1|                 1/2 (factor sqrt 2) in space
///                           -----------   -----------
///                           factor - 1    factor - 1
///
/// The error is of first order in the size of these elements, or better, so that the finer mesh's error is at most the
/// change over (factor - 1) (Richardson). A disc in the section needs three meshes, and the larger of the last two
/// changes counts, because two meshes may agree by chance. Only the elements at the needle, and those at the mouth,
/// follow the level; those far away are refined more slowly, since they matter less.
///
/// A point is `converged` when at least two meshes have an equilibrium there. That does not promise the tolerance: time
/// or the finest level may end the refinement before, and `error_estimate` says what was reached. Under a sharp disc
/// finer meshes lose the solution earlier, so each depth takes the finest mesh that reaches it. A force that only one
/// mesh has is not valid, and the point says why.
class ConvergedForce {
 public:
  /// Throws ConfigError when the scene is not valid or a tensegrity, the withdrawal does not decrease, or the
  /// axisymmetric model is asked for with a needle or a motion beside the axis.
  ConvergedForce(const Scene& scene, const Indenting& indenting, const ConvergedForceConfig& config);

  /// `report` is called after each mesh. Throws ConfigError when the needle is too far from the
  /// axis for a mesh in space, and bad_alloc as said at ConvergedForceConfig::time.
  std::vector<ForcePoint> solve(const std::function<void(const LevelReport&)>& report = {});

  bool axisymmetric() const { return axisymmetric_; }

 private:
  struct Level;
  using Forces = std::vector<std::optional<Eigen::Vector3d>>;  ///< of each depth; empty without equilibrium
  /// For each depth, the force on the finest mesh so far that has one, and its last relative
  /// change.
  struct Before {
    Forces forces;
    std::vector<double> changes;
  };
  template <int Dim>
  CellProblem<Dim> makeProblem(double level) const;
  template <int Dim>
  Level solveLevel(double level) const;
  void adopt(const Level& level, Before& before, std::vector<ForcePoint>& points) const;
  bool done(const ForcePoint& point) const;
  std::vector<std::size_t> order() const;
  bool resolves(const Eigen::Vector3d& displacement) const;
  void abort(const std::string& error, std::vector<ForcePoint>& points) const;
  bool continuePath(const std::vector<ForcePoint>& points, const Level& level) const;

  Scene scene_;
  Indenting indenting_;
  ConvergedForceConfig config_;
  bool axisymmetric_;
};

}  // namespace microinjection
