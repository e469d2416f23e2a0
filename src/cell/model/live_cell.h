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

/// Contact point of a needle, as far as the equations depend on it.
struct ContactPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m, of the tip at first contact
  TipPatch patch;                                   ///< vertices that stick to the tip, if known in advance

  /// Whether the equations are the same.
  bool sameAs(const ContactPoint& other) const {
    if (patch.vertices.empty() && other.patch.vertices.empty()) return point == other.point;
    return patch.vertices == other.patch.vertices;
  }
};

/// Motion of the tip within one contact.
struct TipMotion {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, since first contact
  unsigned contact = 0;                                    ///< number of the contact
  std::optional<double> contact_start;                     ///< s, of first contact; none: before it
  double time = 0;                                         ///< s, present
};

/// Successive equilibria of a cell under a tip with one contact point: the part of a LiveCell that changes, with the
/// solver's state. Each solution continues from the one before, because a small motion then takes few Newton
/// iterations. One thread at a time.
class TipPath {
 public:
  virtual ~TipPath() = default;
  /// Equilibrium at the tip's displacement or, if it is far, on the path to it, so that solutions
  /// are frequent. On failure the state stays at the last equilibrium.
  virtual IndentationSolution follow(const TipMotion& move) = 0;
  /// Positions of the surface's vertices at rest, m, see LiveCell; null if they do not depend on
  /// the contact point.
  virtual std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const = 0;
  /// Displacement of the surface's vertices in the present state, m, xyz each.
  virtual Eigen::VectorXd surfaceDisplacement() const = 0;
  /// Struts and cables in the present state, if the cell has any, in the order of
  /// LiveCell::undeformedMembers().
  virtual std::vector<CellModel::Member> members() const { return {}; }
  /// Present positions of LiveCell::Surface::border_vertices, m.
  virtual std::vector<Eigen::Vector3d> borderVertices() const { return {}; }
};

/// A cell whose equations are solved while the needle moves. LiveCellModel serves every such cell in the same way
/// (thread, extrapolation, contact); what differs between cells is behind this interface:
///
///     class            serves                       mechanics
///     P1Cell           a disc on an elastic cell    the paper's P1 tetrahedra: fast, and they lock
///     LiveFemCell      any other continuum          P2-P0 on a coarse swept mesh
///     TensegrityCell   a tensegrity scene           struts, cables and membrane
///
/// Three threads use one cell, so it is immutable, and what changes is in the TipPath of the thread that solves:
///
///     thread that steps    refusal(), touch(), isClear(), contactAt(), preparedDisplacement()
///     thread that solves   path(), once for each contact point; then TipPath::follow() for each request
///     thread that draws    onSurface()
///
/// Frame: the cell's centre is the origin, metres.
class LiveCell {
 public:
  /// The surface for display; its vertices are those of TipPath::surfaceDisplacement().
  struct Surface {
    std::vector<Eigen::Vector3d> vertices;      ///< m
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
    std::vector<std::uint32_t> held;            ///< vertices in the holding pipette
    /// Of the borders between layers, where the cell has them in its mesh.
    std::vector<Eigen::Vector3d> border_vertices;  ///< m
    std::vector<CellModel::BorderTriangle> borders;
  };

  virtual ~LiveCell() = default;
  virtual const Scene& scene() const = 0;
  /// User-readable description of the model with its accuracy.
  virtual std::string description() const = 0;
  /// Reason why a needle along `axis` (unit, out of the cell) cannot be served; null if it can.
  virtual const char* refusal(const Eigen::Vector3d& axis) const = 0;

  /// First contact point with the undeformed cell, m, of a tip on the line through `tip` along
  /// `axis`; empty when it passes the cell. `hint` speeds up the caller's next search.
  virtual std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                               int& hint) const = 0;
  /// Whether a tip with this contact point is off the undeformed cell, above it or beside it.
  virtual bool isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                       const Eigen::Vector3d& contact_point) const = 0;
  virtual ContactPoint contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const = 0;

  /// Displacement of the tip, m, for which a contact is solved before first contact. The tangent
  /// there is used until the first solution of the contact.
  virtual Eigen::Vector3d preparedDisplacement() const = 0;
  /// May take a while. Throws std::exception when the contact cannot be solved. The path may
  /// outlive this.
  virtual std::unique_ptr<TipPath> path(const ContactPoint& contact_point) const = 0;

  virtual Surface undeformedSurface() const = 0;
  virtual std::vector<std::uint32_t> onSurface(const TipPatch& patch) const = 0;  ///< vertices of the surface
  /// Struts and cables without the needle, if the cell has any.
  virtual std::vector<CellModel::Member> undeformedMembers() const { return {}; }
};

/// m, about which a hand trembles: a tenth of the tip's radius. A smaller shift is no new contact
/// point.
double tremorAllowance(const Scene::Needle& needle);
/// A touch close to the scene's needle line is moved onto it, where the mesh has the tip's circle.
Eigen::Vector3d snapToNeedleLine(const Scene::Needle& needle, const Eigen::Vector3d& touch);

/// The live model of a scene without surrogate data: TensegrityCell for a tensegrity scene, else
/// P1Cell if the scene allows it, because it is faster, else LiveFemCell. Throws ConfigError for
/// a bad scene, and std::runtime_error as their constructors do.
std::shared_ptr<const LiveCell> makeLiveCell(const Scene& scene);

}  // namespace microinjection
