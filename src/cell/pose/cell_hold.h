#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "cell/pose/cell_motion.h"

namespace microinjection {

/// Where a cell is that its holding pipette holds by suction only: it follows the mouth until the needle's load exceeds
/// what the suction bears (HoldLimits), and then moves as CellMotion has it, until the mouth has it again.
///
///                      load > limit, or no suction            needle through a membrane
///     held ------------------------------------------> moving --------------------------> carried by the needle
///      ^  offset: the mouth's                        CellMotion                             offset: the tip's
///      |-- sealed, at rest, load < limit ---------------'                                         |
///      '---------------------------------------------------- at the mouth, sealed ----------------'
///
/// While the cell is held, the force on the needle is that of its model, which is fixed at the mouth. So a cell that is
/// held from the start is computed as one whose pipette has no pressure, bit for bit; one that is picked up sits deeper
/// by what the lip dents it. While it moves, the force is that of
/// CellMotion's contact, whose stiffness follows the model's: Hertz's law is that of small dents only. A needle in a
/// cell that nothing holds feels the medium's drag on it, 0.1 nN, which is left out. Where two of these follow each
/// other, their difference decays with kFade.
///
/// Frame of positions and forces: the scene's, `world`: z along the holding pipette, which is below, and origin where
/// the cell's centre is at the start. The dish lies below, at -y: the microscope looks up along y. Not thread-safe.
class CellHold {
 public:
  static constexpr double kFade = 10e-3;  ///< s

  struct Needle {
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< m
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, out of the cell
    bool inside = false;                              ///< through the outermost membrane
  };
  struct Input {
    Eigen::Vector3d mouth = Eigen::Vector3d::Zero();  ///< m, how far the holding pipette is from its place at the start
    double pressure = 0;                              ///< Pa, gauge, in the mouth; < 0 holds
    std::optional<Needle> needle;
  };
  struct State {
    CellMode mode = CellMode::kFree;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();                 ///< m, of the centre from its place
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the cell, since the start
    bool sealed = false;                                              ///< the lip touches it all round
    double load = 0;                                                  ///< N, of the needle
    double limit = 0;            ///< N, that the suction bears in the load's direction; infinite: HoldLimits::largest
    double leak = 0;             ///< m^3/s, into the mouth
    double seal_resistance = 0;  ///< Pa s/m^3, of the gap between lip and cell; infinite: closed
  };

  /// @param config its radius is the cell's, and its dish_height counts from the cell's lowest point, m
  /// @param mouth of side 1
  /// @throws ConfigError
  CellHold(const CellMotionConfig& config, const PipetteMouth& mouth, const RoundedTip& tip);

  /// Moves the cell through `duration` (s). A `duration` of 0 places it. An input that is not finite is not used.
  const State& step(double duration, const Input& input);
  /// Call once after step(), with the model's force of the cell at `state().offset`, N. @returns that on the needle
  Eigen::Vector3d forceOnNeedle(const Eigen::Vector3d& of_model);

  const State& state() const { return state_; }

 private:
  enum class Regime { kHeld, kMoving, kCarried };

  CellMotionInput inDish(const Input& input) const;
  double limit(const Input& input, const HoldLimits& limits) const;
  Eigen::Vector3d centreInDish() const;
  void move(double duration, const Input& input, bool holds);
  void carry(const Input& input);
  void copyMotion();
  void enter(Regime regime);

  double radius_;
  RoundedTip tip_;
  CellMotion motion_;
  double mouth_height_;  ///< m, of the lip's crest at the start, z
  Regime regime_ = Regime::kMoving;
  State state_;
  Input last_;
  bool placed_ = false;
  double duration_ = 0;                                  ///< s, of the last step
  Eigen::Vector3d of_model_ = Eigen::Vector3d::Zero();   ///< N, last
  Eigen::Vector3d on_needle_ = Eigen::Vector3d::Zero();  ///< N, last
  Eigen::Vector3d fading_ = Eigen::Vector3d::Zero();     ///< N, difference of two regimes
  bool changed_ = false;                                 ///< the regime, in the last step
};

}  // namespace microinjection
