#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// What the cell does to the needle now.
struct TipForce {
  bool valid = true;  ///< false: no trustworthy force at the tip's pose; `force` is then zero
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N, of the cell on the tip
};

/// A cell model that serves a moving needle at the needle's rate: contact and force, and what a PuncturableCell adds.
/// Frame: the cell's centre at rest is the origin, the holding pipette below. All is asked in the thread that steps,
/// but for what draws it.
class CellModel {
 public:
  struct Contact {
    Eigen::Vector3d contact_point = Eigen::Vector3d::Zero();  ///< m, where the tip met the surface
    Eigen::Vector3d displacement = Eigen::Vector3d::Zero();   ///< m, of the tip since then
    double indentation = 0;                                   ///< m, along the pipette into the cell
  };
  /// Piece of a strut or cable of a cell that has some.
  struct Member {
    enum class Kind { kStrut, kActin, kIntermediate };
    Kind kind = Kind::kStrut;
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  ///< m
    double force = 0;                                                              ///< N, positive where it pulls
  };
  /// The surface, deformed. Vertices correspond from picture to picture.
  struct DeformedSurface {
    std::vector<Eigen::Vector3d> vertices;  ///< m
    std::vector<double> displacement;       ///< m, magnitude
    std::vector<std::uint32_t> touched;     ///< vertices that move with the tip
    std::vector<Member> members;            ///< correspond from picture to picture
    std::vector<Eigen::Vector3d> holes;     ///< m, where the outermost layer was punctured, at rest
  };
  /// How far the needle has come into the cell.
  struct Insertion {
    bool punctured = false;    ///< some layer was, at some place, since the beginning
    int layers_punctured = 0;  ///< outermost first, at the place where the needle is or, out of the cell, was last
    bool inside = false;       ///< the tip is through the outermost layer
    double depth = 0;          ///< m along the pipette, of the tip below the surface at rest where it is inside
  };
  /// Of the last solution, or of the model's present state.
  struct Solution {
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, force changes by -stiffness dx
    int newton_iterations = 0;
    double cpu_time = 0;  ///< s
    double age = 0;       ///< s
    double smallest_jacobian = 1;
  };

  virtual ~CellModel() = default;

  /// Force for the tip at `tip` (m) with the pipette along `axis` (unit, out of the cell) at `time` (s, increasing).
  virtual TipForce step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) = 0;

  /// Until the next step there is no contact: what was touched has failed.
  virtual void release() = 0;

  virtual const std::optional<Contact>& contact() const = 0;
  virtual Insertion insertion() const { return {}; }
  virtual std::vector<std::string> layers() const { return {}; }  ///< that can be punctured, outermost first
  virtual const std::string& invalidReason() const = 0;           ///< why the last force was not valid; else empty
  virtual std::optional<Solution> solution(double time) const = 0;

  virtual std::vector<std::array<int, 3>> triangles() const = 0;  ///< of the picture, seen from outside
  virtual std::vector<std::uint32_t> held() const = 0;            ///< vertices of the picture in the holding pipette
  /// As of the last step. One thread of any priority may ask for it while another one steps: neither waits.
  virtual DeformedSurface deformedSurface() = 0;
};

}  // namespace microinjection
