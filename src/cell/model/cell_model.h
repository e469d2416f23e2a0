#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/piezo_stroke.h"

namespace microinjection {

struct Scene;

/// Force of the cell on the tip in one step. A force that cannot be trusted is invalid, and never a guess: on an
/// invalid force the controller holds the needle, whereas it would act on a guess. Forces that faded out at the end of
/// a model's range, for example, were detected as punctures (doc/design/surrogate_cell.md).
struct TipForce {
  bool valid = true;  ///< false: the force at the tip's pose is not valid; `force` is then zero
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip
};

/// A cell model that serves a moving needle at the needle's rate: contact, force, and punctures. The node that steps
/// the cell and the thread that publishes its surface know this interface only, so a session is the same whichever
/// model serves it; makeCellModel chooses one by measured error and time. Height and membranes are decorators, because
/// they are the same for every model:
///
///     needle's pose --> PlacedCell --> PuncturableCell --> SurrogateCellModel   a fit to solutions: microseconds
///                        height         membranes,         LiveCellModel        a solver thread, extrapolated
///                                       shaft in the cell  ExplicitCellModel    the paper's dynamics
///
/// A surrogate under a needle that rubs or adheres has WithdrawnCell before it, for the way out.
///
/// The model itself finds first contact and decides when a contact ends, because the end depends on its mechanics: a
/// surface that sticks to the tip follows it a little beyond its place at rest.
///
/// Frame: the cell's centre at rest is the origin, the holding pipette is below (-z). Call all functions in the thread
/// that steps, except deformedSurface(). `tip` is the tip's lowest point, or the centre of a disc.
class CellModel {
 public:
  struct Contact {
    Eigen::Vector3d contact_point = Eigen::Vector3d::Zero();  ///< m, where the tip met the undeformed surface
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();   ///< m, of the tip since then
    double indentation = 0;                                   ///< m, along the pipette into the cell
  };
  /// Piece of a strut or cable, if the cell has any.
  struct Member {
    enum class Kind { kStrut, kActin, kIntermediate };
    Kind kind = Kind::kStrut;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< m
    double force = 0;                                                              ///< N, positive in tension
  };
  /// A triangle of the border between a layer and the one inside of it, if the model has any.
  struct BorderTriangle {
    std::array<int, 3> vertices;  ///< of DeformedSurface::border_vertices
    int layer = 0;                ///< whose outer surface it is, 1 for the second from outside
  };
  /// The deformed surface. Vertices correspond between calls.
  struct DeformedSurface {
    std::vector<Eigen::Vector3d> vertices;         ///< m
    std::vector<Eigen::Vector3d> at_rest;          ///< m, the same vertices without a needle
    std::vector<double> displacement;              ///< m, magnitude
    std::vector<std::uint32_t> contact_vertices;   ///< vertices that move with the tip
    std::vector<Member> members;                   ///< correspond between calls
    std::vector<Eigen::Vector3d> border_vertices;  ///< m, of the borders between layers
    std::vector<Eigen::Vector3d> holes;            ///< m, punctures of the outermost layer, positions at rest
    std::shared_ptr<const Scene> scene;            ///< whose force is felt; null if it is that of the start
  };
  /// Progress of the needle into the cell.
  struct Insertion {
    bool punctured = false;    ///< a layer has failed at any position since the start
    int layers_punctured = 0;  ///< outermost first, at the needle's present or, outside of the cell, last hole
    bool inside = false;       ///< the tip is through the outermost layer
    double depth = 0;          ///< m along the pipette, of the tip below the surface at rest, while inside
  };
  /// Data of the last solution, or of the model's present state. `cpu_time` is that of the thread that solves, and
  /// `age` the time since the solution was requested; both are 0 for a model that does not solve.
  struct Solution {
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, force changes by -stiffness dx
    int newton_iterations = 0;
    double cpu_time = 0;  ///< s
    double age = 0;       ///< s
    double smallest_jacobian = 1;
  };

  /// The pressure behind a needle's bore.
  struct BoreLine {
    /// Pa, by which the pressure behind the liquid is below that at which nothing flows; below 0: the needle injects.
    double suction = 0;
    double resistance = 1e15;  ///< Pa s/m^3, > 0, of the needle to its liquid
  };
  /// What the suction in a needle's bore has drawn in.
  struct Bore {
    bool covered = false;  ///< the cell is before the mouth; else all numbers but the flow are 0
    double suction = 0;    ///< Pa, that the cell at the mouth withstands
    double length = 0;     ///< m, of the cell in the bore, from its mouth
    double volume = 0;     ///< m^3, same
    double flow = 0;       ///< m^3/s, into the bore
    double tension = 0;    ///< N/m, of an intact membrane over the mouth
  };

  virtual ~CellModel() = default;

  /// Force for the tip at `tip` (m) with the pipette along `axis` (unit, out of the cell) at `time` (s, increasing).
  /// A pose that is not finite, or that the model cannot serve, gives an invalid force.
  virtual TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) = 0;

  /// The pressure in the needle's bore from the next step on. Models of needles without a bore do not feel it.
  virtual void setBoreLine(const BoreLine& /*line*/) {}
  /// The needle gives one pulse in the next step. Models without membranes do not feel it.
  virtual void strike(const PiezoPulse& /*pulse*/) {}
  virtual const Bore* bore() const { return nullptr; }  ///< at the last step; null: the needle has no bore

  /// Removes the contact after a membrane has failed. The next step() finds a new one.
  virtual void release() = 0;

  virtual const std::optional<Contact>& contact() const = 0;
  /// m, of the surface at rest that the needle touches, if it can change.
  virtual std::optional<double> radius() const { return std::nullopt; }
  virtual Insertion insertion() const { return {}; }
  virtual std::vector<std::string> layers() const { return {}; }  ///< of membranes that can fail, outermost first
  virtual const std::string& invalidReason() const = 0;           ///< of the last force; empty if it was valid
  /// N, that the last force may be off the converged one: one of ten is off by more. Nothing: not known, as where
  /// springs stand for what nobody has solved, or beside what was prepared.
  virtual std::optional<double> forceError() const { return std::nullopt; }
  virtual std::optional<Solution> solution(double time) const = 0;

  virtual std::vector<std::array<int, 3>> triangles() const = 0;  ///< of the surface, counter-clockwise outside
  virtual std::vector<std::uint32_t> held() const = 0;            ///< vertices of the surface in the holding pipette
  virtual std::vector<BorderTriangle> borders() const { return {}; }  ///< between layers
  /// Surface at the last step. One thread of any priority may call it while another one steps; neither blocks, so that
  /// drawing at 60 Hz cannot delay a force at 1 kHz.
  virtual DeformedSurface deformedSurface() = 0;
};

}  // namespace microinjection
