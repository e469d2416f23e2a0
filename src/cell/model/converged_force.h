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

/// A needle pushed to one depth after the other.
struct Indenting {
  std::vector<double> depths;                         ///< m, each >= 0, in any order
  Eigen::Vector2d lateral = Eigen::Vector2d::Zero();  ///< m, of the tip at every depth, reached along a straight line
  std::optional<double> speed;                        ///< m/s, of the tip; none: so slowly that nothing viscous resists
  double hold = 0;                                    ///< s at each depth before the force is taken
  /// m, ever smaller, from below the deepest of `depths` on: of the tip drawn back, straight, at the same speed. Below
  /// 0 the tip is above where it touched, and adhesion pulls it.
  std::vector<double> withdrawal;

  std::size_t count() const { return depths.size() + withdrawal.size(); }
  /// Of the i-th force: depths, then withdrawal.
  double depth(std::size_t i) const { return i < depths.size() ? depths[i] : withdrawal[i - depths.size()]; }
  /// Throws ConfigError when the withdrawal is none.
  void validate() const;
};

struct ConvergedForceConfig {
  enum class Model {
    kAuto,          ///< axisymmetric where the scene allows it
    kAxisymmetric,  ///< the section
    kSpatial        ///< in space, see sweepSection
  };
  Model model = Model::kAuto;
  ElementKind element = ElementKind::kP2P0;
  double tolerance = 0.005;  ///< wanted relative error of the force
  double finest = 6;         ///< last level of refinement that may be tried, see scene_mesh.h
  double time = 600;         ///< s of wall time after which no third or finer level is begun
};

/// Force at one depth.
struct ForcePoint {
  double depth = 0;  ///< m
  bool converged = false;
  std::string reason;  ///< why not, or, when converged, why no finer mesh has a solution; else empty
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the needle
  /// Relative, from the last two levels; on withdrawal, where the force changes its sign, to the largest on the path.
  double error_estimate = std::numeric_limits<double>::quiet_NaN();
  double level = -1;     ///< of the mesh that the force was found on
  double wall_time = 0;  ///< s, of all levels
};

/// What was done on one mesh.
struct LevelReport {
  double level = 0;  ///< see scene_mesh.h
  std::size_t nodes = 0, elements = 0;
  int unknowns = 0;
  double wall_time = 0;        ///< s
  std::vector<double> forces;  ///< N, size of the force at each depth (order of Indenting::depth), nan where none
};

/// Solves a scene on finer and finer meshes until two of them agree to the tolerance at every depth. Elements at the
/// needle's edge are refined from mesh to mesh by a factor (2 in the section, sqrt 2 in space) and the error is of
/// first order in their size, or better, so that the finer mesh's error is at most the change over (factor - 1). A
/// depth is converged when there is an equilibrium on two meshes at least, the second the finest that was needed; where
/// finer meshes lose the solution before a depth that a single coarse one reaches, there is none to trust, and the
/// point says so.
class ConvergedForce {
 public:
  /// Throws ConfigError when the model does not fit the scene.
  ConvergedForce(const Scene& scene, const Indenting& indenting, const ConvergedForceConfig& config);

  /// `report` is called after each mesh. Throws ConfigError when the needle is too far out to be meshed in space.
  std::vector<ForcePoint> solve(const std::function<void(const LevelReport&)>& report = {});

  bool axisymmetric() const { return axisymmetric_; }

 private:
  struct Level;
  using Forces = std::vector<std::optional<Eigen::Vector3d>>;  ///< of each depth; empty where there is no equilibrium
  /// Of each depth: the force on the finest mesh so far that had one, and by how much it had changed there (relative).
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
  void abort(const std::string& why, std::vector<ForcePoint>& points) const;
  bool continuePath(const std::vector<ForcePoint>& points, const Level& level) const;

  Scene scene_;
  Indenting indenting_;
  ConvergedForceConfig config_;
  bool axisymmetric_;
};

}  // namespace microinjection
