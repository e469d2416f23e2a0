#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/contact/tip_patch.h"
#include "cell/model/cell_model.h"
#include "cell/model/indentation_solution.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Where a needle touches, as far as the equations depend on it.
struct ContactPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, of the tip when it touches
  TipPatch patch;                                   ///< what sticks to the tip, where touching does not decide that

  /// Whether the equations are the same.
  bool sameAs(const ContactPoint& other) const {
    if (patch.vertices.empty() && other.patch.vertices.empty()) return point == other.point;
    return patch.vertices == other.patch.vertices;
  }
};

/// Where the tip is in one contact.
struct TipMotion {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, since it touched
  unsigned contact = 0;                                    ///< counts the contacts
  std::optional<double> touched;                           ///< s, when it touched; none: it is about to
  double time = 0;                                         ///< s, now
};

/// Equilibria of a cell under a tip that touched it at one place, one after the other. One thread at a time.
class TipPath {
 public:
  virtual ~TipPath() = default;
  /// At the tip's displacement or, where the way there is long, on it: an answer is to come often. On failure the state
  /// stays at the last equilibrium that was found.
  virtual IndentationSolution follow(const TipMotion& move) = 0;
  /// m, of the vertices of the picture at rest, see OnlineCell; null: they do not depend on the place.
  virtual std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const = 0;
  /// m, xyz of each of them, in the present state.
  virtual Eigen::VectorXd surfaceDisplacement() const = 0;
  /// Struts and cables in the present state, where the cell has some; in the order of OnlineCell::undeformedMembers().
  virtual std::vector<CellModel::Member> members() const { return {}; }
};

/// A cell whose equations are solved while the needle moves. Immutable, and safe to share between threads. Frame: the
/// cell's centre is the origin, metres.
class OnlineCell {
 public:
  /// The surface for people.
  struct Surface {
    std::vector<Eigen::Vector3d> vertices;      ///< m
    std::vector<std::array<int, 3>> triangles;  ///< seen from outside
    std::vector<std::uint32_t> held;            ///< vertices in the holding pipette
  };

  virtual ~OnlineCell() = default;
  virtual const Scene& scene() const = 0;
  /// What it is and how far to trust it, for people.
  virtual std::string description() const = 0;
  /// Why a needle along `axis` (unit, out of the cell) cannot be served; null when it can.
  virtual const char* refusal(const Eigen::Vector3d& axis) const = 0;

  /// Where a tip on the line through `tip` along `axis` touches the undeformed cell, m; nothing where it passes by.
  /// `hint` makes the next search of the same asker quicker.
  virtual std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                               int& hint) const = 0;
  /// Whether a tip that has touched at `contact_point`, or would on its line, is off the undeformed cell: above where
  /// it touched, or aside.
  virtual bool isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                       const Eigen::Vector3d& contact_point) const = 0;
  virtual ContactPoint contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const = 0;

  /// m, displacement of the tip at which a contact is solved before it touches. A tangent there has to serve until the
  /// first solution of the contact.
  virtual Eigen::Vector3d preparedDisplacement() const = 0;
  /// May take a while. Throws std::exception where there is no solving. The path may outlive this.
  virtual std::unique_ptr<TipPath> path(const ContactPoint& place) const = 0;

  virtual Surface undeformedSurface() const = 0;
  virtual std::vector<std::uint32_t> onSurface(const TipPatch& patch) const = 0;  ///< vertices of the picture
  /// Struts and cables without the needle, where the cell has some.
  virtual std::vector<CellModel::Member> undeformedMembers() const { return {}; }
};

/// The cell that serves a needle where nothing is prepared: TensegrityCell for a scene of that model, else P1Cell
/// where that can, which is quick, else OnlineFemCell. Throws ConfigError for a bad scene, std::runtime_error as they
/// do.
std::shared_ptr<const OnlineCell> makeOnlineCell(const Scene& scene);

}  // namespace microinjection
