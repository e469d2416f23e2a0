#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace microinjection {

struct Scene;

/// Equilibria of a cell with a hole under a needle, and the crack that makes the hole longer (doc/design/puncture.md).
///
/// The needle's end is at the depth d below the undeformed pole, the hole's undeformed length is l. The energies Pi0(d)
/// of the whole cell and Pi(d, l) of cells with holes of a few lengths are known. The force on the needle is the
/// derivative by d. The crack costs c = 2 pi b J for each metre, in each of the cell's layers with its own toughness J.
/// It grows where the energy that it releases exceeds its cost,
///
///     -dPi/dl at a fixed d  >=  c,
///
/// and it begins where some length has a smaller sum of energy and cost than the whole cell has. Between both there is
/// a barrier, because a hole that is shorter than the tip is round is not opened by the shaft: so the force falls at
/// the onset. A material of a known strength gives way where that is exceeded instead.
///
/// Between the lengths Pi is interpolated at a fixed d - l, the tip's place beyond the bottom of the undeformed hole,
/// on which it depends strongly while it depends on l almost linearly. Forces and releases are derivatives of the one
/// interpolant, hence conservative. All functions are O(number of lengths) and do not allocate.
class PiercedBranch {
 public:
  struct Knot {
    double beyond = 0;  ///< m, d - l
    double force = 0;   ///< N, on the needle, out of the cell
    double energy = 0;  ///< J
  };
  struct Hole {
    double length = 0;        ///< m, undeformed
    std::vector<Knot> knots;  ///< beyond rises
  };
  struct State {
    double force = 0, energy = 0;  ///< N, J
    double release = 0;            ///< N: J per metre of crack, at a fixed needle
  };
  struct Onset {
    double depth = 0, force = 0;           ///< m, N, of the whole cell
    double length = 0, pierced_force = 0;  ///< m, N, of the hole that has been made
  };

  /// What a hole costs beside the energy of the cell.
  struct Crack {
    struct Part {
      double from = 0;  ///< m, length of the hole at which this layer begins
      double cost = 0;  ///< N: J per metre of crack, >= 0
    };
    std::vector<Part> parts = {Part()};  ///< by rising length, the first from 0
    double barrier = 0;                  ///< J, to begin a hole
    double wall_force = 0;               ///< N/m, of the wall on each metre of shaft, the sum of its pressure around it
    double hole_radius = 0;              ///< m, undeformed
    double gives_way = 0;                ///< m, depth at which the material's strength is exceeded; 0: energy decides
  };

  /// @param whole of the cell without a hole. @param holes of rising lengths, two or more. Each path has two knots or
  /// more. Throws std::invalid_argument otherwise.
  PiercedBranch(std::vector<Knot> whole, std::vector<Hole> holes, Crack crack);

  State whole(double depth) const;  ///< its release is 0

  /// Constant forces are taken below the first knot of a path, and a constant stiffness beyond its last one. Energy and
  /// force are continued linearly in the length to shorter holes than the first and longer ones than the last.
  State at(double depth, double length) const;

  /// Where the needle stands in a hole that is solved there. None: the whole cell's path ends before.
  const std::optional<Onset>& onset() const { return onset_; }

  /// What a crack meets besides its cost.
  struct Resistance {
    double tougher = 1;    ///< times the cost
    double stiffness = 0;  ///< N/m, of a membrane that the tip stretches before it
    double membrane = 0;   ///< m below the surface, undeformed, where that is
    double at(double length) const { return stiffness * std::max(length - membrane, 0.0); }  ///< N, of the membrane
  };
  /// m, of a hole that was `length` long while the needle went on to `depth`. It does not become shorter. The energy of
  /// a membrane before the tip is a function of the length alone, so that the needle feels it by a deeper dent.
  double grown(double depth, double length, const Resistance& resistance) const;
  double grown(double depth, double length) const { return grown(depth, length, {}); }

  /// The same cell with so many times the cost.
  PiercedBranch tougher(double factor) const;

  double shortest() const { return holes_.front().length; }  ///< m
  double longest() const { return holes_.back().length; }    ///< m
  const Crack& crack() const { return crack_; }
  double costAt(double length) const;     ///< N, of a crack that is as long
  double costUntil(double length) const;  ///< J, without the barrier
  const std::vector<Hole>& holes() const { return holes_; }

 private:
  std::optional<Onset> findOnset() const;
  std::size_t rightOf(double length) const;  ///< of the two holes between which a length is
  bool isSolved(double depth, double length) const;

  std::vector<Knot> whole_;
  std::vector<Hole> holes_;
  Crack crack_;
  double furthest_ = 0;  ///< m, beyond the bottom, that the furthest of the paths reaches
  std::optional<Onset> onset_;
};

}  // namespace microinjection
